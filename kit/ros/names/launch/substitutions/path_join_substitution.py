"""launch.substitutions.path_join_substitution of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.substitutions import (
        PathJoinSubstitution as PathJoinSubstitution,
        SomeText as _SomeSubstitutionsType,
        Substitution as Substitution,
    )

    SomeSubstitutionsType = _SomeSubstitutionsType
else:
    _LATE_NAMES = {
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "PathJoinSubstitution": "kit.ros.launch.substitutions:PathJoinSubstitution",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "Substitution": "kit.ros.launch.substitutions:Substitution",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
