"""Starts the world with one robot. And the program that drives it."""

# Lesson: Its parameter `speed` must come from a launch argument of the same name

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    share = FindPackageShare("convoy")
    return LaunchDescription([
        DeclareLaunchArgument("speed", default_value="0.2"),

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

        Node(
            package="convoy",
            executable="cruise",
            name="driver",
            parameters=[{"speed": 0.2}],
            remappings=[("command", "cmd_vel")],
        ),
    ])
