"""launch_ros.actions.set_parameter of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.entity import Action as Action
    from kit.ros.launch.normalization import (
        normalize_to_list_of_substitutions as normalize_to_list_of_substitutions,
    )
    from kit.ros.launch.parameters import ParameterValue as ParameterValue
    from kit.ros.launch.processes import SetParameter as SetParameter
    from kit.ros.launch.substitutions import SomeText as _SomeSubstitutionsType

    SomeSubstitutionsType = _SomeSubstitutionsType
    Entity: Any
    ParameterName: Any
    Parser: Any
    SomeParameterValue: Any
    evaluate_parameter_dict: Any
    expose_action: Any
    normalize_parameter_dict: Any
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "Entity": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "ParameterName": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "ParameterValue": "kit.ros.launch.parameters:ParameterValue",
        "Parser": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SetParameter": "kit.ros.launch.processes:SetParameter",
        "SomeParameterValue": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "evaluate_parameter_dict": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "expose_action": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "normalize_parameter_dict": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "normalize_to_list_of_substitutions": "kit.ros.launch.normalization:normalize_to_list_of_substitutions",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
