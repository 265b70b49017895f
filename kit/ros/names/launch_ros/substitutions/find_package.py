"""launch_ros.substitutions.find_package of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.file_substitutions import (
        FindPackagePrefix as _FindPackage,
        FindPackagePrefix as FindPackagePrefix,
        FindPackageShare as FindPackageShare,
    )
    from kit.ros.launch.normalization import (
        normalize_to_list_of_substitutions as normalize_to_list_of_substitutions,
        perform as _perform_substitutions,
    )
    from kit.ros.launch.substitutions import SomeText as _SomeSubstitutionsType, Substitution as Substitution
    from kit.ros.package_index import (
        get_package_prefix as get_package_prefix,
        get_package_share_directory as get_package_share_directory,
    )

    FindPackage = _FindPackage
    SomeSubstitutionsType = _SomeSubstitutionsType
    perform_substitutions = _perform_substitutions
    expose_substitution: Any
else:
    _LATE_NAMES = {
        "FindPackage": "kit.ros.launch.file_substitutions:FindPackagePrefix",
        "FindPackagePrefix": "kit.ros.launch.file_substitutions:FindPackagePrefix",
        "FindPackageShare": "kit.ros.launch.file_substitutions:FindPackageShare",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "Substitution": "kit.ros.launch.substitutions:Substitution",
        "expose_substitution": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "get_package_prefix": "kit.ros.package_index:get_package_prefix",
        "get_package_share_directory": "kit.ros.package_index:get_package_share_directory",
        "normalize_to_list_of_substitutions": "kit.ros.launch.normalization:normalize_to_list_of_substitutions",
        "perform_substitutions": "kit.ros.launch.normalization:perform",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
