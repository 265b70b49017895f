"""launch_ros.actions.lifecycle_node of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.entity import Action as Action
    from kit.ros.launch.events import ChangeState as ChangeState, StateTransition as StateTransition
    from kit.ros.launch.processes import LifecycleNode as LifecycleNode, Node as Node
    from kit.ros.launch.substitutions import SomeText as _SomeSubstitutionsType

    SomeSubstitutionsType = _SomeSubstitutionsType
    get_ros_node: Any
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "ChangeState": "kit.ros.launch.events:ChangeState",
        "LifecycleNode": "kit.ros.launch.processes:LifecycleNode",
        "Node": "kit.ros.launch.processes:Node",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "StateTransition": "kit.ros.launch.events:StateTransition",
        "get_ros_node": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
