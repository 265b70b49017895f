"""Drives ``turtle1`` with the keys of the terminal: arrows, and the letters around F for absolute headings."""

import math
import os
import select
import sys
import termios
import tty
from typing import Any

import rclpy
from geometry_msgs.msg import Twist
from rclpy.action import ActionClient
from rclpy.node import Node
from turtlesim.action import RotateAbsolute

ARROWS = {"A": (1.0, 0.0), "B": (-1.0, 0.0), "C": (0.0, -1.0), "D": (0.0, 1.0)}
"""The last letter of an arrow key's sequence: how much ahead and to the left."""
HEADINGS = {
    letter: number * math.pi / 4
    for letter, number in {"g": 0, "t": 1, "r": 2, "e": 3, "d": 4, "c": -3, "v": -2, "b": -1}.items()
}

HELP = """Reading from keyboard
---------------------------
Use arrow keys to move the turtle.
Use G|B|V|C|D|E|R|T keys to rotate to absolute orientations. 'F' to cancel a rotation.
'Q' to quit.
"""


class TeleopTurtle(Node):
    """Publishes a command for each arrow key; sends a goal for each letter."""

    def __init__(self) -> None:
        super().__init__("teleop_turtle")
        self.declare_parameter("scale_linear", 2.0)
        self.declare_parameter("scale_angular", 2.0)
        self.publisher = self.create_publisher(Twist, "turtle1/cmd_vel", 1)
        self.rotation = ActionClient(self, RotateAbsolute, "turtle1/rotate_absolute")
        self.goal: Any = None

    def drive(self, linear: float, angular: float) -> None:
        command = Twist()
        command.linear.x = linear * self.get_parameter("scale_linear").value
        command.angular.z = angular * self.get_parameter("scale_angular").value
        self.publisher.publish(command)

    def rotate(self, theta: float) -> None:
        goal = RotateAbsolute.Goal()
        goal.theta = theta
        self.rotation.send_goal_async(goal).add_done_callback(self.keep)

    def keep(self, future: Any) -> None:
        self.goal = future.result()

    def cancel(self) -> None:
        if self.goal is not None:
            self.goal.cancel_goal_async()
            self.goal = None


def read_keys() -> str:
    """What was typed within a tenth of a second; empty if nothing was."""
    readable, _, _ = select.select([sys.stdin], [], [], 0.1)
    return os.read(sys.stdin.fileno(), 64).decode("utf-8", "replace") if readable else ""


def apply_keys(node: TeleopTurtle, keys: str) -> bool:
    """Does what keys say; False for the end."""
    while keys:
        if keys[:2] == "\x1b[" and keys[2:3] in ARROWS:
            node.drive(*ARROWS[keys[2]])
            keys = keys[3:]
            continue
        key, keys = keys[0].lower(), keys[1:]
        if key == "q":
            return False
        if key == "f":
            node.cancel()
        elif key in HEADINGS:
            node.rotate(HEADINGS[key])
    return True


def main() -> None:
    rclpy.init()
    node = TeleopTurtle()
    sys.stdout.write(HELP)
    sys.stdout.flush()
    settings = termios.tcgetattr(sys.stdin)
    tty.setcbreak(sys.stdin)
    try:
        while apply_keys(node, read_keys()):
            rclpy.spin_once(node, timeout_sec=0)
    except KeyboardInterrupt:
        pass
    finally:
        termios.tcsetattr(sys.stdin, termios.TCSADRAIN, settings)
