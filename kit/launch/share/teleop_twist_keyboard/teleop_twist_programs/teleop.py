"""Drives a robot with the keys of the terminal: publishes ``cmd_vel`` for each key, at speeds that keys change."""

import sys
import termios
import tty

import rclpy
from geometry_msgs.msg import Twist, TwistStamped
from rclpy.node import Node

HELP = """Reading from the keyboard and publishing to cmd_vel
---------------------------
Moving around:          Holding Shift, sideways:
   u    i    o             U    I    O
   j    k    l             J    K    L
   m    ,    .             M    <    >

t : up (+z)    b : down (-z)    anything else : stop
q/z : both speeds 10 % up/down, w/x : only linear, e/c : only angular
CTRL-C to quit
"""

MOVES = {
    "i": (1, 0, 0, 0), "o": (1, 0, 0, -1), "j": (0, 0, 0, 1), "l": (0, 0, 0, -1), "u": (1, 0, 0, 1),
    ",": (-1, 0, 0, 0), ".": (-1, 0, 0, 1), "m": (-1, 0, 0, -1), "I": (1, 0, 0, 0), "O": (1, -1, 0, 0),
    "J": (0, 1, 0, 0), "L": (0, -1, 0, 0), "U": (1, 1, 0, 0), "<": (-1, 0, 0, 0), ">": (-1, -1, 0, 0),
    "M": (-1, 1, 0, 0), "t": (0, 0, 1, 0), "b": (0, 0, -1, 0),
}  # fmt: skip
"""Per key how much ahead, to the left, up and round."""
SPEEDS = {
    "q": (1.1, 1.1), "z": (0.9, 0.9), "w": (1.1, 1.0), "x": (0.9, 1.0), "e": (1.0, 1.1), "c": (1.0, 0.9),
}  # fmt: skip
"""Factors of the linear and the angular speed."""


class TeleopTwistKeyboard(Node):
    """Keeps the speeds and publishes the commands."""

    def __init__(self) -> None:
        super().__init__("teleop_twist_keyboard")
        self.declare_parameter("stamped", False)
        self.declare_parameter("frame_id", "")
        self.declare_parameter("speed", 0.5)
        self.declare_parameter("turn", 1.0)
        self.speed = self.get_parameter("speed").value
        self.turn = self.get_parameter("turn").value
        self.is_stamped = self.get_parameter("stamped").value
        self.publisher = self.create_publisher(TwistStamped if self.is_stamped else Twist, "cmd_vel", 10)

    def apply_key(self, key: str) -> None:
        """Does what a key says."""
        if key in SPEEDS:
            linear, angular = SPEEDS[key]
            self.speed, self.turn = self.speed * linear, self.turn * angular
            self.say_speeds()
            return
        ahead, left, up, around = MOVES.get(key, (0, 0, 0, 0))
        command = Twist()
        command.linear.x, command.linear.y, command.linear.z = (
            part * self.speed for part in (ahead, left, up)
        )
        command.angular.z = around * self.turn
        if not self.is_stamped:
            self.publisher.publish(command)
            return
        stamped = TwistStamped()
        stamped.header.stamp = self.get_clock().now().to_msg()
        stamped.header.frame_id = self.get_parameter("frame_id").value
        stamped.twist = command
        self.publisher.publish(stamped)

    def say_speeds(self) -> None:
        sys.stdout.write(f"currently:\tspeed {self.speed:.3g}\tturn {self.turn:.3g}\r\n")
        sys.stdout.flush()


def main() -> None:
    rclpy.init()
    node = TeleopTwistKeyboard()
    settings = termios.tcgetattr(sys.stdin)
    try:
        tty.setraw(sys.stdin.fileno())
        sys.stdout.write(HELP.replace("\n", "\r\n"))
        node.say_speeds()
        while (key := sys.stdin.read(1)) not in ("\x03", ""):
            node.apply_key(key)
            rclpy.spin_once(node, timeout_sec=0)
    finally:
        node.apply_key("k")
        termios.tcsetattr(sys.stdin, termios.TCSADRAIN, settings)
