#!/usr/bin/env python3
# What "ros2 run pkg node --ros-args --params-file robots.yaml -r __ns:=/fleet" does, in one file.
import os
import tempfile
import rclpy
from rclpy.node import Node
from std_msgs.msg import String

YAML = """
/fleet/greeter:
  ros__parameters:
    robot_name: marvin
    period: 0.25
    limits:
      linear: 0.7
      angular: 1.5
    tags: [indoor, slow]
    ids: [4, 8, 15]
/**:
  ros__parameters:
    owner: lab
"""


class Greeter(Node):
    def __init__(self):
        super().__init__('greeter', allow_undeclared_parameters=True,
                         automatically_declare_parameters_from_overrides=True)
        name = self.get_parameter('robot_name').value
        limits = self.get_parameters_by_prefix('limits')
        for key in sorted(limits):
            self.get_logger().info(f'limit {key} = {limits[key].value}')
        self.get_logger().info('tags: ' + ', '.join(self.get_parameter('tags').value))
        self.get_logger().info('sum of ids: %d' % sum(self.get_parameter('ids').value))
        self.get_logger().info('owner: ' + self.get_parameter('owner').value)
        self.get_logger().info('I am ' + self.get_fully_qualified_name())
        self.pub = self.create_publisher(String, 'greetings', 10)
        self.msg = String(data=f'I am {name}')
        self.create_timer(self.get_parameter('period').value, lambda: self.pub.publish(self.msg))


def main():
    fd, path = tempfile.mkstemp(suffix='.yaml')
    with os.fdopen(fd, 'w') as f:
        f.write(YAML)
    rclpy.init(args=['--ros-args', '--params-file', path, '-r', '__ns:=/fleet'])
    node = Greeter()
    try:
        rclpy.spin(node)
    finally:
        os.unlink(path)


if __name__ == '__main__':
    main()
