"""launch.frontend.parser of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import (
        LaunchError as _InvalidFrontendLaunchFileError,
        LaunchError as _InvalidLaunchFileError,
    )
    from kit.ros.launch.entity import Action as Action, LaunchDescription as LaunchDescription
    from kit.ros.launch.frontend.substitution_parser import parse_substitutions as _parse_substitution
    from kit.ros.launch.substitutions import Substitution as Substitution

    InvalidFrontendLaunchFileError = _InvalidFrontendLaunchFileError
    InvalidLaunchFileError = _InvalidLaunchFileError
    parse_substitution = _parse_substitution
    Entity: Any
    FilePath: Any
    NormalizedValueType: Any
    Parser: Any
    StrSomeValueType: Any
    instantiate_action: Any
    parse_if_substitutions: Any
    replace_escaped_characters: Any
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "Entity": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "FilePath": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "InvalidFrontendLaunchFileError": "kit.ros.launch.context:LaunchError",
        "InvalidLaunchFileError": "kit.ros.launch.context:LaunchError",
        "LaunchDescription": "kit.ros.launch.entity:LaunchDescription",
        "NormalizedValueType": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "Parser": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "StrSomeValueType": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "Substitution": "kit.ros.launch.substitutions:Substitution",
        "instantiate_action": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "parse_if_substitutions": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "parse_substitution": "kit.ros.launch.frontend.substitution_parser:parse_substitutions",
        "replace_escaped_characters": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
