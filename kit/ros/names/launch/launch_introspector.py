"""launch.launch_introspector of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.actions import (
        EmitEvent as EmitEvent,
        LogInfo as LogInfo,
        RegisterEventHandler as RegisterEventHandler,
    )
    from kit.ros.launch.entity import (
        Action as Action,
        LaunchDescription as LaunchDescription,
        LaunchDescriptionEntity as LaunchDescriptionEntity,
    )
    from kit.ros.launch.event_handlers import EventHandler as _BaseEventHandler
    from kit.ros.launch.introspection import (
        LaunchIntrospector as LaunchIntrospector,
        format_action as format_action,
        format_entities as format_entities,
        format_event_handler as format_event_handler,
        format_substitutions as format_substitutions,
        indent as indent,
        tree_like_indent as tree_like_indent,
    )
    from kit.ros.launch.normalization import (
        is_a as is_a,
        normalize_to_list_of_substitutions as normalize_to_list_of_substitutions,
    )
    from kit.ros.launch.processes import ExecuteProcess as ExecuteProcess
    from kit.ros.launch.substitutions import SomeText as _SomeSubstitutionsType

    BaseEventHandler = _BaseEventHandler
    SomeSubstitutionsType = _SomeSubstitutionsType
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "BaseEventHandler": "kit.ros.launch.event_handlers:EventHandler",
        "EmitEvent": "kit.ros.launch.actions:EmitEvent",
        "ExecuteProcess": "kit.ros.launch.processes:ExecuteProcess",
        "LaunchDescription": "kit.ros.launch.entity:LaunchDescription",
        "LaunchDescriptionEntity": "kit.ros.launch.entity:LaunchDescriptionEntity",
        "LaunchIntrospector": "kit.ros.launch.introspection:LaunchIntrospector",
        "LogInfo": "kit.ros.launch.actions:LogInfo",
        "RegisterEventHandler": "kit.ros.launch.actions:RegisterEventHandler",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "format_action": "kit.ros.launch.introspection:format_action",
        "format_entities": "kit.ros.launch.introspection:format_entities",
        "format_event_handler": "kit.ros.launch.introspection:format_event_handler",
        "format_substitutions": "kit.ros.launch.introspection:format_substitutions",
        "indent": "kit.ros.launch.introspection:indent",
        "is_a": "kit.ros.launch.normalization:is_a",
        "normalize_to_list_of_substitutions": "kit.ros.launch.normalization:normalize_to_list_of_substitutions",
        "tree_like_indent": "kit.ros.launch.introspection:tree_like_indent",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
