"""launch.launch_description_sources.frontend_launch_description_source of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.description_sources import (
        LaunchDescriptionSource as _FrontendLaunchDescriptionSource,
        LaunchDescriptionSource as LaunchDescriptionSource,
    )
    from kit.ros.launch.substitutions import SomeText as _SomeSubstitutionsType

    FrontendLaunchDescriptionSource = _FrontendLaunchDescriptionSource
    SomeSubstitutionsType = _SomeSubstitutionsType
    Parser: Any
    get_launch_description_from_frontend_launch_file: Any
else:
    _LATE_NAMES = {
        "FrontendLaunchDescriptionSource": "kit.ros.launch.description_sources:LaunchDescriptionSource",
        "LaunchDescriptionSource": "kit.ros.launch.description_sources:LaunchDescriptionSource",
        "Parser": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "get_launch_description_from_frontend_launch_file": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
