"""launch.substitutions.boolean_substitution of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.normalization import (
        normalize_to_list_of_substitutions as normalize_to_list_of_substitutions,
    )
    from kit.ros.launch.substitutions import (
        AllSubstitution as AllSubstitution,
        AndSubstitution as AndSubstitution,
        AnySubstitution as AnySubstitution,
        NotSubstitution as NotSubstitution,
        OrSubstitution as OrSubstitution,
        SomeText as _SomeSubstitutionsType,
        Substitution as Substitution,
        SubstitutionFailure as SubstitutionFailure,
    )

    SomeSubstitutionsType = _SomeSubstitutionsType
    expose_substitution: Any
    perform_typed_substitution: Any
else:
    _LATE_NAMES = {
        "AllSubstitution": "kit.ros.launch.substitutions:AllSubstitution",
        "AndSubstitution": "kit.ros.launch.substitutions:AndSubstitution",
        "AnySubstitution": "kit.ros.launch.substitutions:AnySubstitution",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "NotSubstitution": "kit.ros.launch.substitutions:NotSubstitution",
        "OrSubstitution": "kit.ros.launch.substitutions:OrSubstitution",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "Substitution": "kit.ros.launch.substitutions:Substitution",
        "SubstitutionFailure": "kit.ros.launch.substitutions:SubstitutionFailure",
        "expose_substitution": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "normalize_to_list_of_substitutions": "kit.ros.launch.normalization:normalize_to_list_of_substitutions",
        "perform_typed_substitution": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
