"""The node alone, as ``kit ros run turtlesim turtlesim_node`` starts it; ``words``: what follows the program's name."""

import shlex

from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def make_node(context: LaunchContext) -> list[Node]:
    words = shlex.split(LaunchConfiguration("words").perform(context))
    return [Node(package="turtlesim", executable="turtlesim_node", arguments=words)]


def generate_launch_description() -> LaunchDescription:
    words = DeclareLaunchArgument("words", default_value="", description="the program's own arguments")
    return LaunchDescription([words, OpaqueFunction(function=make_node)])
