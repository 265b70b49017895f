#!/usr/bin/env python3
# Draws a house (Haus vom Nikolaus) by driving with feedback to one corner after another.
import math
from collections import deque

import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.task import Future
from geometry_msgs.msg import Twist
from turtlesim.msg import Pose

CORNERS = [(8.0, 5.544), (5.544, 8.0), (8.0, 8.0), (6.77, 9.5), (5.544, 8.0), (5.544, 5.544), (8.0, 8.0), (8.0, 5.544)]


class House(Node):

    def __init__(self):
        super().__init__('house')
        self.todo = deque(CORNERS)
        self.finished = Future()
        self.pub = self.create_publisher(Twist, '/turtle1/cmd_vel', QoSProfile(depth=1))
        self.sub = self.create_subscription(Pose, '/turtle1/pose', self.feedback, QoSProfile(depth=1))

    def feedback(self, pose):
        cmd = Twist()
        if self.todo:
            x, y = self.todo[0]
            d = math.hypot(x - pose.x, y - pose.y)
            e = math.remainder(math.atan2(y - pose.y, x - pose.x) - pose.theta, math.tau)
            if d < 0.05:
                self.todo.popleft()
                self.get_logger().info('%d corners left' % len(self.todo))
            elif abs(e) > 0.02 and d > 0.15:
                cmd.angular.z = 3.0 * e
                # rotate first, only then go
                if abs(e) < 0.1:
                    cmd.linear.x = min(2.0, 2 * d)
            else:
                cmd.linear.x = min(2.0, 2 * d)
        elif not self.finished.done():
            self.finished.set_result('this is the house of Santa Claus')
        self.pub.publish(cmd)


def main():
    rclpy.init()
    node = House()
    rclpy.spin_until_future_complete(node, node.finished)
    print(node.finished.result())
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
