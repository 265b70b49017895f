"""launch.descriptions.executable of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.entity import Action as Action
    from kit.ros.launch.normalization import (
        normalize_to_list_of_substitutions as normalize_to_list_of_substitutions,
        perform as _perform_substitutions,
    )
    from kit.ros.launch.processes import Executable as Executable
    from kit.ros.launch.substitutions import (
        LaunchConfiguration as LaunchConfiguration,
        SomeText as _SomeSubstitutionsType,
        Substitution as Substitution,
    )

    SomeSubstitutionsType = _SomeSubstitutionsType
    perform_substitutions = _perform_substitutions
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "Executable": "kit.ros.launch.processes:Executable",
        "LaunchConfiguration": "kit.ros.launch.substitutions:LaunchConfiguration",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "Substitution": "kit.ros.launch.substitutions:Substitution",
        "normalize_to_list_of_substitutions": "kit.ros.launch.normalization:normalize_to_list_of_substitutions",
        "perform_substitutions": "kit.ros.launch.normalization:perform",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
