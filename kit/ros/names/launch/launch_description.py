"""launch.launch_description of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name
from kit.ros.launch.entity import LaunchDescription

__all__ = ["LaunchDescription"]

if TYPE_CHECKING:
    from kit.ros.launch.actions import (
        DeclareLaunchArgument as DeclareLaunchArgument,
        IncludeLaunchDescription as IncludeLaunchDescription,
    )
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.entity import Action as Action, LaunchDescriptionEntity as LaunchDescriptionEntity
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "DeclareLaunchArgument": "kit.ros.launch.actions:DeclareLaunchArgument",
        "IncludeLaunchDescription": "kit.ros.launch.actions:IncludeLaunchDescription",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "LaunchDescriptionEntity": "kit.ros.launch.entity:LaunchDescriptionEntity",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
