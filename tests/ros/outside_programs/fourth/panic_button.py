"""Drives by cmd_vel_raw; presses the emergency stop after 2 s, releases it after 2 more, looks at the latched state."""
import threading

import rclpy
from geometry_msgs.msg import Twist
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import Bool
from std_srvs.srv import SetBool, Trigger

rclpy.init()
node = rclpy.create_node("panic_button")
threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start()
pub = node.create_publisher(Twist, "cmd_vel_raw", 10)
button = node.create_client(SetBool, "estop")
counter = node.create_client(Trigger, "estop/reset_count")
button.wait_for_service()
counter.wait_for_service()
rate = node.create_rate(10)
ahead = Twist()
ahead.linear.x = 0.25


def drive(ticks):
    for _ in range(ticks):
        pub.publish(ahead)
        rate.sleep()


drive(20)
print(button.call(SetBool.Request(data=True)).message)
drive(20)
heard = []
node.create_subscription(Bool, "estop/engaged", lambda m: heard.append(m.data),
                         QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))
while not heard:
    rate.sleep()
print(button.call(SetBool.Request(data=False)).message)
drive(20)
pub.publish(Twist())
print(counter.call(Trigger.Request()).message)
print("states", heard, flush=True)
