"""launch.substitutions.command of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.file_substitutions import Command as Command
    from kit.ros.launch.substitutions import (
        SomeText as _SomeSubstitutionsType,
        Substitution as Substitution,
        SubstitutionFailure as SubstitutionFailure,
    )

    SomeSubstitutionsType = _SomeSubstitutionsType
    expose_substitution: Any
else:
    _LATE_NAMES = {
        "Command": "kit.ros.launch.file_substitutions:Command",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "Substitution": "kit.ros.launch.substitutions:Substitution",
        "SubstitutionFailure": "kit.ros.launch.substitutions:SubstitutionFailure",
        "expose_substitution": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
