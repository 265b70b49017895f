import sys

import rclpy
from rclpy.node import Node
from std_msgs.msg import Int32


class Scale(Node):
    def __init__(self, expected):
        super().__init__('scale')
        self.total = 0
        self.count = 0
        self.expected = expected
        self.create_subscription(Int32, '/all', self.weigh, 10)

    def weigh(self, item):
        self.total += item.data
        self.count += 1
        if self.count == self.expected:
            self.get_logger().info(f'total {self.total} of {self.count}')
            raise SystemExit(0)


def main():
    rclpy.init()
    rest = rclpy.utilities.remove_ros_args(sys.argv)
    rclpy.spin(Scale(int(rest[1])))
