"""launch_ros.actions.ros_timer of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from functools import partial as partial
    from kit.ros.launch.actions import (
        TimerAction as _ROSTimer,
        TimerAction as _RosTimer,
        TimerAction as TimerAction,
    )
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.entity import LaunchDescriptionEntity as LaunchDescriptionEntity
    from kit.ros.launch.normalization import (
        TEXT_TYPES as _SomeSubstitutionsType_types_tuple,
        ensure_argument_type as ensure_argument_type,
    )
    from kit.ros.launch.substitutions import SomeText as _SomeSubstitutionsType

    ROSTimer = _ROSTimer
    RosTimer = _RosTimer
    SomeSubstitutionsType = _SomeSubstitutionsType
    SomeSubstitutionsType_types_tuple = _SomeSubstitutionsType_types_tuple
    Entity: Any
    Parser: Any
    TimerEvent: Any
    create_future: Any
    expose_action: Any
    get_ros_node: Any
    type_utils: Any
else:
    _LATE_NAMES = {
        "Entity": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "LaunchDescriptionEntity": "kit.ros.launch.entity:LaunchDescriptionEntity",
        "Parser": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "ROSTimer": "kit.ros.launch.actions:TimerAction",
        "RosTimer": "kit.ros.launch.actions:TimerAction",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "SomeSubstitutionsType_types_tuple": "kit.ros.launch.normalization:TEXT_TYPES",
        "TimerAction": "kit.ros.launch.actions:TimerAction",
        "TimerEvent": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "create_future": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "ensure_argument_type": "kit.ros.launch.normalization:ensure_argument_type",
        "expose_action": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "get_ros_node": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "partial": "functools:partial",
        "type_utils": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
