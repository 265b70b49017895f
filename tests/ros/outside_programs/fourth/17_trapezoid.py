import time
from collections import deque
from threading import Thread

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry

V_MAX, ACC, DIST, DT = 0.5, 0.5, 2.0, 0.02


def profile():
    t_acc = V_MAX / ACC
    t_flat = (DIST - V_MAX * t_acc) / V_MAX
    t = 0.0
    while t < 2 * t_acc + t_flat:
        if t < t_acc:
            yield ACC * t
        elif t < t_acc + t_flat:
            yield V_MAX
        else:
            yield max(0.0, V_MAX - ACC * (t - t_acc - t_flat))
        t += DT


def main():
    rclpy.init()
    node = rclpy.create_node("trapezoid")
    pub = node.create_publisher(Twist, "cmd_vel", 10)
    poses = deque(maxlen=1)
    node.create_subscription(Odometry, "odom", poses.append, 10)
    thread = Thread(target=rclpy.spin, args=(node,), daemon=True)
    thread.start()
    while not poses:          # wait for odometry
        pass
    start = poses[0].pose.pose.position.x
    began = time.monotonic()
    due = began
    fastest = 0.0
    for v in profile():
        msg = Twist()
        msg.linear.x = v
        pub.publish(msg)
        due += DT
        fastest = max(fastest, poses[0].twist.twist.linear.x)
        time.sleep(max(0.0, due - time.monotonic()))
    pub.publish(Twist())
    took = time.monotonic() - began
    time.sleep(0.5)
    print(f"drove {poses[0].pose.pose.position.x - start:.2f} m in {took:.1f} s, at most {fastest:.2f} m/s")
    rclpy.shutdown()


main()
