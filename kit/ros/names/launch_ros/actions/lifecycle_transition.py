"""launch_ros.actions.lifecycle_transition of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.msg.lifecycle_msgs import Transition as Transition
    from kit.ros.launch.actions import EmitEvent as EmitEvent, RegisterEventHandler as RegisterEventHandler
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.entity import Action as Action
    from kit.ros.launch.event_handlers import OnStateTransition as OnStateTransition
    from kit.ros.launch.events import (
        ChangeState as ChangeState,
        StateTransition as StateTransition,
        matches_node_name as matches_node_name,
    )
    from kit.ros.launch.normalization import (
        normalize_to_list_of_substitutions as normalize_to_list_of_substitutions,
        perform as _perform_substitutions,
    )
    from kit.ros.launch.processes import LifecycleTransition as LifecycleTransition
    from kit.ros.launch.substitutions import SomeText as _SomeSubstitutionsType

    SomeSubstitutionsType = _SomeSubstitutionsType
    perform_substitutions = _perform_substitutions
    match_node_name_goal: Any
    match_node_name_start_goal: Any
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "ChangeState": "kit.ros.launch.events:ChangeState",
        "EmitEvent": "kit.ros.launch.actions:EmitEvent",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "LifecycleTransition": "kit.ros.launch.processes:LifecycleTransition",
        "OnStateTransition": "kit.ros.launch.event_handlers:OnStateTransition",
        "RegisterEventHandler": "kit.ros.launch.actions:RegisterEventHandler",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "StateTransition": "kit.ros.launch.events:StateTransition",
        "Transition": "kit.msg.lifecycle_msgs:Transition",
        "match_node_name_goal": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "match_node_name_start_goal": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "matches_node_name": "kit.ros.launch.events:matches_node_name",
        "normalize_to_list_of_substitutions": "kit.ros.launch.normalization:normalize_to_list_of_substitutions",
        "perform_substitutions": "kit.ros.launch.normalization:perform",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
