#!/usr/bin/env python3
import sys
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist
from turtlesim.msg import Pose


class Spiral(Node):
    def __init__(self, wk=3.0, rk=0.0):
        super().__init__('spiral')
        self.wk, self.rk = wk, rk
        self.pose = Pose()
        self.velocity_publisher = self.create_publisher(Twist, '/turtle1/cmd_vel', 10)
        self.sub = self.create_subscription(Pose, '/turtle1/pose', self.poseCallback, 10)
        self.timer = self.create_timer(0.1, self.spiral)

    def poseCallback(self, pose_message):
        self.pose = pose_message

    def spiral(self):
        if self.pose.x == 0.0:
            return   # nothing heard yet
        if self.pose.x < 9.0 and self.pose.y < 9.0:
            self.rk += 0.03
            vel = Twist()
            vel.linear.x = self.rk
            vel.angular.z = self.wk
            self.velocity_publisher.publish(vel)
        else:
            self.velocity_publisher.publish(Twist())
            self.get_logger().info('outermost radius %.1f' % (self.rk / self.wk))
            self.timer.cancel()


def main():
    rclpy.init(args=sys.argv)
    node = Spiral()
    executor = rclpy.executors.SingleThreadedExecutor()
    executor.add_node(node)
    try:
        while not node.timer.is_canceled():
            executor.spin_once(timeout_sec=1.0)
    finally:
        executor.shutdown()
        node.destroy_node()
        rclpy.shutdown()


if __name__ == '__main__':
    main()
