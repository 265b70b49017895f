"""The example program of many tests: a node that publishes the same command again and again."""

from __future__ import annotations

from textwrap import indent

_PROGRAM = """\
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Driver(Node):
    def __init__(self):
        super().__init__("{name}")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.count = 0
        self.create_timer({period_s}, self.go)

    def go(self):
        self.count += 1
        command = Twist()
        command.linear.x = {speed}
        command.angular.z = {turning}
        self.drive.publish(command)
{then}


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Driver())


if __name__ == "__main__":
    main()
"""


def driving_program(
    speed: object = 0.0,
    turning: object = 0.0,
    *,
    then: str = "",
    period_s: float = 0.1,
    name: str = "driver",
) -> str:
    """Returns its source. ``speed`` [m/s] and ``turning`` [rad/s] are numbers or the source of an expression; ``then`` is what
    it does after it has published, and may ask ``self.count``, the number of this turn. ``name`` is the node's."""
    lines = indent(then or "pass", 8 * " ")
    return _PROGRAM.format(speed=speed, turning=turning, period_s=period_s, then=lines, name=name)
