"""Teleop for two: the arrow keys drive two robots side by side as if they were one; or one robot alone.

Listens to the same keystroke messages as ``teleop``. What is steered is the point between the two: the outer robot of
a bend keeps its speed, the inner one is slower, and both turn at the same rate, so that they stay abreast.
"""

import math

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from std_msgs.msg import Float32, String


class TeleopPair(Node):
    def __init__(self) -> None:
        super().__init__("teleop_pair")
        self.speed = self.declare_parameter("speed", 0.52).value  # m/s, of the outer robot of a bend
        self.turn_rate = self.declare_parameter("turn_rate", 0.8).value  # rad/s
        models = self.declare_parameter("models", ["left", "right"]).value
        # Two robots have namespaces of their own names; one alone has ours.
        self.models = {name: f"/{name}/" if len(models) > 1 else "" for name in models}
        self.held: set[str] = set()
        self.strength = 1.0
        self.poses: dict[str, tuple[float, float, float]] = {}
        self.drives = {
            name: self.create_publisher(Twist, f"{space}cmd_vel", 10) for name, space in self.models.items()
        }
        self.create_subscription(String, "/teleopkeys", self.on_key, 10)
        self.create_subscription(Float32, "/teleopkeys/strength", self.on_strength, 10)
        for name, space in self.models.items():
            self.create_subscription(
                Odometry,
                f"{space}odom",
                lambda message, name=name: self.on_odometry(name, message),
                10,
            )

    def on_key(self, message: String) -> None:
        event, _, key = message.data.partition("_")
        if event == "p":
            self.held.add(key)
        else:
            self.held.discard(key)
        if key == "space":
            self.held.clear()
        self.send()

    def on_strength(self, message: Float32) -> None:
        self.strength = message.data
        self.send()

    def on_odometry(self, name: str, message: Odometry) -> None:
        pose = message.pose.pose
        heading = 2.0 * math.atan2(pose.orientation.z, pose.orientation.w)
        self.poses[name] = pose.position.x, pose.position.y, heading
        if self.held:
            self.send()

    def send(self) -> None:
        """Each robot drives as its place beside the middle asks: v - turn * y, where y is how far to the left it is."""
        turn = self.strength * self.turn_rate * (("left" in self.held) - ("right" in self.held))
        middle_x = sum(pose[0] for pose in self.poses.values()) / max(1, len(self.poses))
        middle_y = sum(pose[1] for pose in self.poses.values()) / max(1, len(self.poses))
        lefts = dict.fromkeys(self.drives, 0.0)
        for name, (x, y, heading) in self.poses.items():
            lefts[name] = -math.sin(heading) * (x - middle_x) + math.cos(heading) * (y - middle_y)
        top = self.strength * self.speed - abs(turn) * max(map(abs, lefts.values()))
        forward = top * (("up" in self.held) - ("down" in self.held))
        for name, drive in self.drives.items():
            command = Twist()
            command.linear.x = forward - turn * lefts[name]
            command.angular.z = turn
            drive.publish(command)


def main(args: list[str] | None = None) -> None:
    rclpy.init(args=args)
    rclpy.spin(TeleopPair())


if __name__ == "__main__":
    main()
