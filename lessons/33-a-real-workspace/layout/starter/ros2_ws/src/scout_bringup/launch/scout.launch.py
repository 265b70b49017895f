import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    world = os.path.join(get_package_share_directory("scout_bringup"), "world", "world.yaml")
    return LaunchDescription(
        [
            Node(package="flatland_server", executable="flatland_server", parameters=[{"world_path": world}]),
            Node(package="scout_driver", executable="cruise", name="driver"),
        ]
    )
