"""launch.actions.unset_environment_variable of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.entity import Action as Action
    from kit.ros.launch.normalization import (
        normalize_to_list_of_substitutions as normalize_to_list_of_substitutions,
        perform as _perform_substitutions,
    )
    from kit.ros.launch.settings import UnsetEnvironmentVariable as UnsetEnvironmentVariable
    from kit.ros.launch.substitutions import SomeText as _SomeSubstitutionsType, Substitution as Substitution

    SomeSubstitutionsType = _SomeSubstitutionsType
    perform_substitutions = _perform_substitutions
    Entity: Any
    Parser: Any
    expose_action: Any
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "Entity": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "Parser": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "Substitution": "kit.ros.launch.substitutions:Substitution",
        "UnsetEnvironmentVariable": "kit.ros.launch.settings:UnsetEnvironmentVariable",
        "expose_action": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "normalize_to_list_of_substitutions": "kit.ros.launch.normalization:normalize_to_list_of_substitutions",
        "perform_substitutions": "kit.ros.launch.normalization:perform",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
