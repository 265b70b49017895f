"""Teleop: drive with the arrow keys or WASD. Warns near walls, and slows down towards them.

Listens to the keystroke messages ``p_up``, ``r_up``, ``p_left`` and so on (pressed, released) on
``/teleopkeys``. A collision sends the robot back to where it started.
"""

import math

import rclpy
from flatland_msgs.msg import Collisions
from flatland_msgs.srv import MoveModel
from geometry_msgs.msg import Pose2D, Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32, String

SIDES = {
    "front": 0.0,
    "left": math.pi / 2,
    "back": math.pi,
    "right": -math.pi / 2,
}  # [rad] from straight ahead
HALF_WIDTH = math.radians(45)  # a ray this far from a side's middle, or nearer, belongs to it


class Teleop(Node):
    def __init__(self) -> None:
        super().__init__("teleop")
        self.speed = self.declare_parameter("speed", 0.5).value  # m/s
        self.turn_rate = self.declare_parameter("turn_rate", 1.5).value  # rad/s
        self.wall_distance = self.declare_parameter("wall_distance", 0.2).value  # m
        self.home = self.declare_parameter("home", [0.0, 0.0, -math.pi / 2]).value  # x, y, theta
        self.model = self.declare_parameter("model", "serp").value
        self.held: set[str] = set()
        self.strength = 1.0  # below 1 while the terminal cannot tell whether a key is still down
        self.near: tuple[str, ...] = ()  # the sides on which a wall is near

        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.move_model = self.create_client(MoveModel, "/move_model")
        self.create_subscription(String, "/teleopkeys", self.on_key, 10)
        self.create_subscription(Float32, "/teleopkeys/strength", self.on_strength, 10)
        self.create_subscription(LaserScan, "static_laser", self.on_scan, 10)
        self.create_subscription(Collisions, "collisions", self.on_collisions, 10)

    def on_key(self, message: String) -> None:
        event, _, key = message.data.partition("_")
        if event == "p":
            self.held.add(key)
        else:
            self.held.discard(key)
        if message.data == "p_space":
            self.held.clear()
        self.send()

    def on_strength(self, message: Float32) -> None:
        self.strength = message.data
        self.send()

    def on_scan(self, scan: LaserScan) -> None:
        angles = [
            scan.angle_min + i * scan.angle_increment
            for i, r in enumerate(scan.ranges)
            if r < self.wall_distance
        ]
        near = tuple(
            side
            for side, middle in SIDES.items()
            if any(abs(math.remainder(angle - middle, math.tau)) <= HALF_WIDTH for angle in angles)
        )
        if near != self.near:
            self.near = near
            if near:
                self.get_logger().warning(f"Obstacle near: {', '.join(near)}.")
            self.send()

    def on_collisions(self, message: Collisions) -> None:
        if not message.collisions:
            return
        self.get_logger().info("Bumped: back to the start. Press a key again to drive on.")
        self.held.clear()
        self.send()
        x, y, theta = self.home
        self.move_model.call_async(MoveModel.Request(name=self.model, pose=Pose2D(x=x, y=y, theta=theta)))

    def send(self) -> None:
        """Keys add up, and opposite keys cancel."""
        command = Twist()
        command.linear.x = self.strength * self.speed * (("up" in self.held) - ("down" in self.held))
        command.angular.z = self.strength * self.turn_rate * (("left" in self.held) - ("right" in self.held))
        if ("front" if command.linear.x > 0 else "back") in self.near:
            command.linear.x /= 2
        self.drive.publish(command)


def main(args: list[str] | None = None) -> None:
    rclpy.init(args=args)
    rclpy.spin(Teleop())


if __name__ == "__main__":
    main()
