"""launch_ros.actions.set_use_sim_time of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.entity import Action as Action
    from kit.ros.launch.parameters import Parameter as Parameter
    from kit.ros.launch.processes import SetUseSimTime as SetUseSimTime
    Entity: Any
    Parser: Any
    expose_action: Any
    get_ros_node: Any
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "Entity": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "Parameter": "kit.ros.launch.parameters:Parameter",
        "Parser": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SetUseSimTime": "kit.ros.launch.processes:SetUseSimTime",
        "expose_action": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "get_ros_node": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
