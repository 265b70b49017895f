"""launch.actions.group_action of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.entity import Action as Action, LaunchDescriptionEntity as LaunchDescriptionEntity
    from kit.ros.launch.settings import (
        GroupAction as GroupAction,
        PopEnvironment as PopEnvironment,
        PopLaunchConfigurations as PopLaunchConfigurations,
        PushEnvironment as PushEnvironment,
        PushLaunchConfigurations as PushLaunchConfigurations,
        ResetEnvironment as ResetEnvironment,
        ResetLaunchConfigurations as ResetLaunchConfigurations,
        SetLaunchConfiguration as SetLaunchConfiguration,
    )
    from kit.ros.launch.substitutions import SomeText as _SomeSubstitutionsType

    SomeSubstitutionsType = _SomeSubstitutionsType
    Entity: Any
    Parser: Any
    expose_action: Any
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "Entity": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "GroupAction": "kit.ros.launch.settings:GroupAction",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "LaunchDescriptionEntity": "kit.ros.launch.entity:LaunchDescriptionEntity",
        "Parser": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "PopEnvironment": "kit.ros.launch.settings:PopEnvironment",
        "PopLaunchConfigurations": "kit.ros.launch.settings:PopLaunchConfigurations",
        "PushEnvironment": "kit.ros.launch.settings:PushEnvironment",
        "PushLaunchConfigurations": "kit.ros.launch.settings:PushLaunchConfigurations",
        "ResetEnvironment": "kit.ros.launch.settings:ResetEnvironment",
        "ResetLaunchConfigurations": "kit.ros.launch.settings:ResetLaunchConfigurations",
        "SetLaunchConfiguration": "kit.ros.launch.settings:SetLaunchConfiguration",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "expose_action": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
