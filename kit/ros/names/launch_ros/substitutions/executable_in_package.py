"""launch_ros.substitutions.executable_in_package of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.file_substitutions import (
        ExecutableInPackage as ExecutableInPackage,
        FindPackagePrefix as FindPackagePrefix,
    )
    from kit.ros.launch.normalization import (
        normalize_to_list_of_substitutions as normalize_to_list_of_substitutions,
        perform as _perform_substitutions,
    )
    from kit.ros.launch.substitutions import (
        SomeText as _SomeSubstitutionsType,
        Substitution as Substitution,
        SubstitutionFailure as SubstitutionFailure,
    )
    from shutil import which as which

    SomeSubstitutionsType = _SomeSubstitutionsType
    perform_substitutions = _perform_substitutions
    expose_substitution: Any
else:
    _LATE_NAMES = {
        "ExecutableInPackage": "kit.ros.launch.file_substitutions:ExecutableInPackage",
        "FindPackagePrefix": "kit.ros.launch.file_substitutions:FindPackagePrefix",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "Substitution": "kit.ros.launch.substitutions:Substitution",
        "SubstitutionFailure": "kit.ros.launch.substitutions:SubstitutionFailure",
        "expose_substitution": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "normalize_to_list_of_substitutions": "kit.ros.launch.normalization:normalize_to_list_of_substitutions",
        "perform_substitutions": "kit.ros.launch.normalization:perform",
        "which": "shutil:which",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
