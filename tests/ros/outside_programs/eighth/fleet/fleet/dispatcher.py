import sys

import rclpy
from rclpy.node import Node
from rclpy.utilities import remove_ros_args
from std_msgs.msg import Int32


class Dispatcher(Node):
    def __init__(self, wanted):
        super().__init__('dispatcher')
        self.wanted = wanted
        self.sum = 0
        self.declare_parameter('names', ['nobody'])
        for name in self.get_parameter('names').value:
            self.create_subscription(Int32, f'/{name}/goods', self.on_goods, 10)

    def on_goods(self, message):
        self.sum += message.data
        if self.sum >= self.wanted:
            self.get_logger().info(f'{self.sum} of {self.wanted} are here')
            raise SystemExit(4)


def main():
    rclpy.init()
    arguments = remove_ros_args(sys.argv)
    rclpy.spin(Dispatcher(int(arguments[1])))
