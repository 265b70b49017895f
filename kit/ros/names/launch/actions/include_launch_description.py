"""launch.actions.include_launch_description of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.actions import IncludeLaunchDescription as IncludeLaunchDescription
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.description_sources import (
        LaunchDescriptionSource as _AnyLaunchDescriptionSource,
        LaunchDescriptionSource as LaunchDescriptionSource,
    )
    from kit.ros.launch.entity import Action as Action, LaunchDescriptionEntity as LaunchDescriptionEntity
    from kit.ros.launch.normalization import (
        normalize_to_list_of_substitutions as normalize_to_list_of_substitutions,
        perform as _perform_substitutions,
    )
    from kit.ros.launch.settings import SetLaunchConfiguration as SetLaunchConfiguration
    from kit.ros.launch.substitutions import SomeText as _SomeSubstitutionsType

    AnyLaunchDescriptionSource = _AnyLaunchDescriptionSource
    SomeSubstitutionsType = _SomeSubstitutionsType
    perform_substitutions = _perform_substitutions
    Entity: Any
    Parser: Any
    expose_action: Any
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "AnyLaunchDescriptionSource": "kit.ros.launch.description_sources:LaunchDescriptionSource",
        "Entity": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "IncludeLaunchDescription": "kit.ros.launch.actions:IncludeLaunchDescription",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "LaunchDescriptionEntity": "kit.ros.launch.entity:LaunchDescriptionEntity",
        "LaunchDescriptionSource": "kit.ros.launch.description_sources:LaunchDescriptionSource",
        "Parser": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SetLaunchConfiguration": "kit.ros.launch.settings:SetLaunchConfiguration",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "expose_action": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "normalize_to_list_of_substitutions": "kit.ros.launch.normalization:normalize_to_list_of_substitutions",
        "perform_substitutions": "kit.ros.launch.normalization:perform",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
