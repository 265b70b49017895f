#!/usr/bin/env python3
# Rate.sleep() in the main thread needs somebody else to spin: a MultiThreadedExecutor in a thread, joined at the end
import math
import threading
import rclpy
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from geometry_msgs.msg import Twist
from turtlesim.msg import Pose


class Sine(Node):
    def __init__(self):
        super().__init__('sine')
        self.lock = threading.Lock()
        self.ys = []
        self.pub = self.create_publisher(Twist, '/turtle1/cmd_vel', 10)
        self.create_subscription(Pose, '/turtle1/pose', self.on_pose, 10)
        self.rate = self.create_rate(20.0)

    def on_pose(self, p):
        with self.lock:
            self.ys.append(p.y)

    def swim(self, seconds):
        t0 = self.get_clock().now()
        while True:
            t = (self.get_clock().now() - t0).nanoseconds * 1e-9
            if t >= seconds:
                break
            msg = Twist()
            msg.linear.x = 0.8
            msg.angular.z = 1.2 * math.cos(2 * math.pi * t / 3.0)
            self.pub.publish(msg)
            self.rate.sleep()
        self.pub.publish(Twist())


def main():
    rclpy.init()
    node = Sine()
    executor = MultiThreadedExecutor()
    executor.add_node(node)
    spin = threading.Thread(target=executor.spin)
    spin.start()
    node.swim(6.0)
    with node.lock:
        print(f'{len(node.ys)} poses, y from {min(node.ys):.1f} to {max(node.ys):.1f}')
    executor.shutdown()
    spin.join(timeout=5.0)
    print('spinner alive:', spin.is_alive())
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
