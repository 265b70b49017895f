"""launch_yaml.launch_description_sources.yaml_launch_description_source of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.description_sources import (
        LaunchDescriptionSource as _FrontendLaunchDescriptionSource,
        LaunchDescriptionSource as _YAMLLaunchDescriptionSource,
    )
    from kit.ros.launch.substitutions import SomeText as _SomeSubstitutionsType

    FrontendLaunchDescriptionSource = _FrontendLaunchDescriptionSource
    SomeSubstitutionsType = _SomeSubstitutionsType
    YAMLLaunchDescriptionSource = _YAMLLaunchDescriptionSource
    Parser: Any
else:
    _LATE_NAMES = {
        "FrontendLaunchDescriptionSource": "kit.ros.launch.description_sources:LaunchDescriptionSource",
        "Parser": "!launch's own reader of YAML files; `kit launch FILE` reads them",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "YAMLLaunchDescriptionSource": "kit.ros.launch.description_sources:LaunchDescriptionSource",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
