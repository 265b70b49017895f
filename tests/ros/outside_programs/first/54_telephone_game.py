#!/usr/bin/env python3
import rclpy
from rclpy.node import Node
from rclpy.executors import SingleThreadedExecutor
from std_msgs.msg import String


class Person(Node):
    """hears something on incoming_X, adds its letter, tells it on outgoing_X"""

    def __init__(self, letter, **kwargs):
        super().__init__('node_' + letter, **kwargs)
        self.letter = letter
        self.pub = self.create_publisher(String, f'outgoing_{letter}', 10)
        self.sub = self.create_subscription(String, f'incoming_{letter}', self.hear, 10)

    def hear(self, msg):
        self.pub.publish(String(data=msg.data + self.letter))


class Starter(Person):
    def __init__(self, **kwargs):
        super().__init__('A', **kwargs)
        self.secret = 'psst'
        self.round = 0
        self.timer = self.create_timer(2.0, self.start)

    def start(self):
        self.round += 1
        self.pub.publish(String(data=f'{self.secret}{self.round}'))

    def hear(self, msg):
        self.get_logger().info(f'said "{self.secret}{self.round}", got back "{msg.data}"')


def remap(me, before):
    return ['--ros-args', '-r', f'incoming_{me}:=outgoing_{before}']


def main():
    rclpy.init()
    people = [Starter(cli_args=remap('A', 'D'))]
    for me, before in ('BA', 'CB', 'DC'):
        people.append(Person(me, cli_args=remap(me, before)))
    ex = SingleThreadedExecutor()
    for p in people:
        ex.add_node(p)
    try:
        ex.spin()
    finally:
        ex.shutdown()
        for p in people:
            p.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
