"""Two of them, each with a turtle1 of its own; the first is drawn."""

from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    return LaunchDescription(
        [
            Node(namespace=f"turtlesim{number}", package="turtlesim", executable="turtlesim_node")
            for number in (1, 2)
        ]
    )
