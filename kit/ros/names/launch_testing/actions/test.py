"""launch_testing.actions.test of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.actions import OpaqueFunction as OpaqueFunction, TimerAction as TimerAction
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.entity import Action as Action
    from kit.ros.launch.event_handlers import OnProcessExit as OnProcessExit
    from kit.ros.launch.events import Event as Event
    from kit.ros.launch.normalization import SomeEntities as _SomeActionsType, SomeEntities as _SomeEntitiesType
    from kit.ros.launch.processes import ExecuteProcess as ExecuteProcess
    from kit.ros.launch.substitutions import SomeText as _SomeSubstitutionsType

    SomeActionsType = _SomeActionsType
    SomeEntitiesType = _SomeEntitiesType
    SomeSubstitutionsType = _SomeSubstitutionsType
    Test: Any
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "Event": "kit.ros.launch.events:Event",
        "ExecuteProcess": "kit.ros.launch.processes:ExecuteProcess",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "OnProcessExit": "kit.ros.launch.event_handlers:OnProcessExit",
        "OpaqueFunction": "kit.ros.launch.actions:OpaqueFunction",
        "SomeActionsType": "kit.ros.launch.normalization:SomeEntities",
        "SomeEntitiesType": "kit.ros.launch.normalization:SomeEntities",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "Test": "!a part of launch_testing's own runner, in whose place `kit ros launch_test FILE` runs the file",
        "TimerAction": "kit.ros.launch.actions:TimerAction",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
