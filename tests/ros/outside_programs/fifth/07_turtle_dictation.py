#!/usr/bin/env python3
# Writes a word with turtle1: lift the pen, go to the letter, draw its strokes.
import math

import rclpy
from rclpy.action import ActionClient
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from turtlesim.action import RotateAbsolute
from turtlesim.srv import SetPen, TeleportAbsolute
from geometry_msgs.msg import Twist
from turtlesim.msg import Color, Pose
import threading
import time

LETTERS = {
    'L': [[(0, 2), (0, 0), (1, 0)]],
    'T': [[(0.5, 0), (0.5, 2)], [(0, 2), (1, 2)]],
}


class Writer(Node):
    def __init__(self):
        super().__init__('writer')
        self.declare_parameter('word', 'TL')
        group = ReentrantCallbackGroup()
        self.pen = self.create_client(SetPen, 'turtle1/set_pen', callback_group=group)
        self.tele = self.create_client(TeleportAbsolute, 'turtle1/teleport_absolute', callback_group=group)
        self.rotate = ActionClient(self, RotateAbsolute, 'turtle1/rotate_absolute', callback_group=group)
        self.cmd = self.create_publisher(Twist, 'turtle1/cmd_vel', 1)
        self.sub = self.create_subscription(Pose, 'turtle1/pose', self.on_pose, 1, callback_group=group)
        self.colors = set()
        self.create_subscription(Color, 'turtle1/color_sensor', self.on_color, 1, callback_group=group)
        self.pose = None
        self.got_pose = threading.Event()

    def on_pose(self, msg):
        self.pose = msg
        self.got_pose.set()

    def on_color(self, msg):
        self.colors.add((msg.r, msg.g, msg.b))

    def write(self):
        assert self.rotate.wait_for_server(timeout_sec=10)
        self.pen.wait_for_service()
        self.got_pose.wait()
        word = self.get_parameter('word').get_parameter_value().string_value
        for i, letter in enumerate(word):
            for stroke in LETTERS[letter]:
                points = [(2 + 2.0 * i + x, 4 + y) for x, y in stroke]
                self.pen.call(SetPen.Request(off=True))
                self.tele.call(TeleportAbsolute.Request(x=points[0][0], y=float(points[0][1])))
                self.pen.call(SetPen.Request(r=255, width=2))
                for a, b in zip(points, points[1:]):
                    self.turn(math.atan2(b[1] - a[1], b[0] - a[0]))
                    self.forward(math.dist(a, b))
            self.get_logger().info(f'wrote {letter}')

    def turn(self, angle):
        done = threading.Event()
        goal = self.rotate.send_goal_async(RotateAbsolute.Goal(theta=angle))
        goal.add_done_callback(lambda f: f.result().get_result_async().add_done_callback(lambda _: done.set()))
        done.wait()

    def forward(self, length):
        msg = Twist()
        msg.linear.x = length
        self.cmd.publish(msg)
        time.sleep(1.3)


def main():
    rclpy.init()
    node = Writer()
    executor = MultiThreadedExecutor(4)
    executor.add_node(node)
    spinner = threading.Thread(target=executor.spin, daemon=True)
    spinner.start()
    try:
        node.write()
        print('red seen', (255, 0, 0) in node.colors, flush=True)
    finally:
        executor.shutdown()
        node.destroy_node()
        rclpy.shutdown()
        spinner.join()


if __name__ == '__main__':
    main()
