"""A program with options of its own beside those of ROS: each takes what is meant for it, and a node may have others."""
import argparse
import sys

import rclpy
from rclpy.exceptions import InvalidTopicNameException
from rclpy.expand_topic_name import expand_topic_name
from rclpy.node import Node
from rclpy.utilities import remove_ros_args
from rclpy.validate_full_topic_name import validate_full_topic_name
from rclpy.validate_topic_name import validate_topic_name
from std_msgs.msg import String


class Greeter(Node):
    def __init__(self, count):
        super().__init__('greeter')
        self.left = count
        who = self.declare_parameter('who', 'nobody').value
        self.publisher = self.create_publisher(String, 'greeting', 10)
        self.greeting = f'hello {who}'
        self.create_timer(0.1, self.greet)

    def greet(self):
        if self.left == 0:
            raise StopIteration
        self.left -= 1
        self.publisher.publish(String(data=self.greeting))


def main():
    parser = argparse.ArgumentParser(prog='greet')
    parser.add_argument('--count', type=int, default=1)
    parser.add_argument('--loud', action='store_true')
    options = parser.parse_args(remove_ros_args(args=sys.argv)[1:])
    print('options', options.count, options.loud)

    rclpy.init(args=sys.argv)
    greeter = Greeter(options.count)
    print('is', greeter.get_fully_qualified_name(), 'says', greeter.publisher.topic_name)
    try:
        rclpy.spin(greeter)
    except StopIteration:
        print('said', options.count - greeter.left)

    other = Node('other', use_global_arguments=False,
                 cli_args=['--ros-args', '-r', '__ns:=/yard', '-r', 'greeting:=bark', '-p', 'who:=[rex, bo]'])
    print('other', other.get_fully_qualified_name(), other.resolve_topic_name('greeting'),
          list(other.declare_parameter('who', ['nobody']).value))
    print('expanded', expand_topic_name('~/state', 'arm', '/left'), expand_topic_name('{ns}/x', 'arm', '/left'))
    print('valid', validate_topic_name('a/{ns}/b'), validate_full_topic_name('/a/b'))
    for name, check in (('/a//b', validate_full_topic_name), ('with space', validate_topic_name)):
        try:
            check(name)
        except InvalidTopicNameException as error:
            print('refused', name, 'Invalid topic name' in str(error))
    try:
        other.create_publisher(String, '7up', 10)
    except InvalidTopicNameException:
        print('refused 7up')
    rclpy.shutdown()
    sys.exit(3 if options.loud else 0)


if __name__ == '__main__':
    main()
