"""Prints where one frame is in another, once a second: ``tf2_echo SOURCE TARGET [RATE]``."""

import math
import sys

import rclpy
from rclpy.node import Node
from rclpy.time import Time
from rclpy.utilities import remove_ros_args
from tf2_ros import Buffer, TransformException, TransformListener
from tf_transformations import euler_from_quaternion, quaternion_matrix

USAGE = """Usage: tf2_echo source_frame target_frame [echo_rate]

This will echo the transform from the coordinate frame of the source_frame
to the coordinate frame of the target_frame."""


def numbers(values: list[float]) -> str:
    """A list as ROS 2 prints it."""
    return "[" + ", ".join(f"{value:.3f}" for value in values) + "]"


class TransformEcho(Node):
    """Looks the newest transform up, again and again."""

    def __init__(self, source: str, target: str, rate: float) -> None:
        super().__init__("tf2_echo")
        self.source, self.target = source, target
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.create_timer(1.0 / rate, self.show)

    def show(self) -> None:
        try:
            found = self.buffer.lookup_transform(self.source, self.target, Time())
        except TransformException as problem:
            self.get_logger().info(f"Waiting for transform {self.source} ->  {self.target}: {problem}")
            return
        stamp, move, turn = found.header.stamp, found.transform.translation, found.transform.rotation
        place, quaternion = [move.x, move.y, move.z], [turn.x, turn.y, turn.z, turn.w]
        angles = list(euler_from_quaternion(quaternion))
        print(f"At time {stamp.sec}.{stamp.nanosec:09}")
        print(f"- Translation: {numbers(place)}")
        print(f"- Rotation: in Quaternion (xyzw) {numbers(quaternion)}")
        print(f"- Rotation: in RPY (radian) {numbers(angles)}")
        print(f"- Rotation: in RPY (degree) {numbers([math.degrees(angle) for angle in angles])}")
        print("- Matrix:")
        matrix = quaternion_matrix(quaternion)
        for row in range(4):
            entries = [matrix[row][column] for column in range(3)] + [place[row] if row < 3 else 1.0]
            print(" " + "".join(f" {entry:6.3f}" for entry in entries))
        sys.stdout.flush()


def main() -> None:
    words = remove_ros_args(sys.argv)[1:]
    if len(words) not in (2, 3):
        print(USAGE)
        raise SystemExit(1)
    rate = float(words[2]) if len(words) == 3 else 1.0
    if rate <= 0:
        print("Echo rate must be > 0.0")
        raise SystemExit(1)
    rclpy.init()
    rclpy.spin(TransformEcho(words[0], words[1], rate))
