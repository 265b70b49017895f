#!/usr/bin/env python3
# teleop that dies: 3 s of commands, 3 s of silence, 2 s of commands, then exits
import time
import rclpy
from geometry_msgs.msg import Twist

rclpy.init()
node = rclpy.create_node('flaky_teleop')
pub = node.create_publisher(Twist, '/teleop/cmd_vel', 10)
while pub.get_subscription_count() < 1:
    time.sleep(0.1)
t = Twist()
t.linear.x = 0.3
for n, pause in ((30, 3.0), (20, 0.0)):
    for _ in range(n):
        pub.publish(t)
        time.sleep(0.1)
    time.sleep(pause)
node.destroy_node()
rclpy.shutdown()
