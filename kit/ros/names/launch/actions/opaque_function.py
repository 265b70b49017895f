"""launch.actions.opaque_function of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.actions import OpaqueFunction as OpaqueFunction
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.entity import Action as Action, LaunchDescriptionEntity as LaunchDescriptionEntity
    from kit.ros.launch.normalization import ensure_argument_type as ensure_argument_type
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "LaunchDescriptionEntity": "kit.ros.launch.entity:LaunchDescriptionEntity",
        "OpaqueFunction": "kit.ros.launch.actions:OpaqueFunction",
        "ensure_argument_type": "kit.ros.launch.normalization:ensure_argument_type",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
