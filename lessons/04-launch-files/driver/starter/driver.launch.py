"""Starts the world with one robot. The program that drives it is
missing."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    share = FindPackageShare("convoy")
    return LaunchDescription([
        # TODO: an argument, speed, 0.2 by default

        Node(
            package="flatland_server",
            executable="flatland_server",
            name="flatland_server",
            parameters=[{
                "world_path": PathJoinSubstitution([share, "world", "one.yaml"]),
                "update_rate": 100.0,  # steps a second of wall clock
                "step_size": 0.01,  # simulated seconds of a step
            }],
        ),

        # TODO: the program cruise of the package convoy, as a node
        # called driver. It publishes on command; the robot listens
        # on cmd_vel. Its speed is the argument's.
    ])
