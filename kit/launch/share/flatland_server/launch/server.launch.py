"""Flatland's server with its parameters as arguments: what packages include under this name."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    names = ("world_path", "update_rate", "step_size", "show_viz", "viz_pub_rate", "use_sim_time")
    return LaunchDescription(
        [
            DeclareLaunchArgument("world_path", description="the world's YAML file"),
            DeclareLaunchArgument(
                "update_rate", default_value="200.0", description="steps a second of wall clock"
            ),
            DeclareLaunchArgument(
                "step_size", default_value="0.005", description="simulated seconds of a step"
            ),
            DeclareLaunchArgument("show_viz", default_value="true"),
            DeclareLaunchArgument("viz_pub_rate", default_value="30.0"),
            DeclareLaunchArgument("use_sim_time", default_value="true"),
            DeclareLaunchArgument("use_rviz", default_value="false", description="whether to show the world"),
            Node(
                name="flatland_server",
                package="flatland_server",
                executable="flatland_server",
                output="screen",
                parameters=[{name: LaunchConfiguration(name) for name in names}],
            ),
            Node(package="rviz2", executable="rviz2", condition=IfCondition(LaunchConfiguration("use_rviz"))),
        ]
    )
