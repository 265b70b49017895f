import os
import sys

import rclpy
from rclpy.node import Node
from rclpy.utilities import remove_ros_args
from std_msgs.msg import String


class Guard(Node):
    def __init__(self, slow):
        super().__init__('guard')
        room = self.declare_parameter('room', 'none').value
        level = self.declare_parameter('level', 0).value
        limits = self.declare_parameter('limits', [0.0]).value
        self.declare_parameter('hours.opens', 9)
        self.declare_parameter('hours.closes', 17)
        badge = self.declare_parameter('badge', '-').value
        hours = {name: each.value for name, each in self.get_parameters_by_prefix('hours').items()}
        self.get_logger().info(
            f'{self.get_fully_qualified_name()} in {room} level {level} limits {list(limits)} '
            f'hours {hours["opens"]}-{hours["closes"]} badge {badge} slow {slow} key {os.environ.get("KEY", "-")}')
        self.publisher = self.create_publisher(String, 'alarm', 10)
        self.create_timer(1.0 if slow else 0.5, self.ring)

    def ring(self):
        self.publisher.publish(String(data=f'{self.get_namespace()} quiet'))


def main(args=None):
    rclpy.init(args=args)
    words = remove_ros_args(args=sys.argv)[1:]
    guard = Guard('--slow' in words)
    try:
        rclpy.spin(guard)
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass
    finally:
        guard.destroy_node()
        rclpy.try_shutdown()
