"""A program that handles Ctrl-C itself: it slows the robot down before it goes, instead of leaving it driving."""
import os
import signal

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions


class Cruise(Node):
    def __init__(self):
        super().__init__('cruise')
        self.publisher = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Odometry, 'odom', self.on_odom, 10)
        self.speed, self.goal = 0.0, 0.5
        self.distance = 0.0
        self.last = None
        self.create_timer(0.05, self.step)
        self.create_timer(4.0, lambda: os.kill(os.getpid(), signal.SIGINT))

    def on_odom(self, msg):
        place = msg.pose.pose.position
        if self.last is not None:
            self.distance += ((place.x - self.last[0]) ** 2 + (place.y - self.last[1]) ** 2) ** 0.5
        self.last = place.x, place.y

    def step(self):
        change = max(-0.02, min(0.02, self.goal - self.speed))
        self.speed += change
        command = Twist()
        command.linear.x = self.speed
        self.publisher.publish(command)


def main():
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = Cruise()
    asked = []

    def on_interrupt(number, frame):
        asked.append(number)
        node.goal = 0.0
        print('asked to stop', signal.Signals(number).name)

    signal.signal(signal.SIGINT, on_interrupt)
    rclpy.get_default_context().on_shutdown(lambda: print('context is closed'))
    while rclpy.ok() and not (asked and node.speed == 0.0):
        rclpy.spin_once(node, timeout_sec=0.1)
    print(f'stopped after {node.distance:.1f} m, once {len(asked) == 1}')
    node.destroy_node()
    rclpy.shutdown()
    print('ok', rclpy.ok())


if __name__ == '__main__':
    main()
