"""launch.logging of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.log import get_logger as get_logger
    from kit.ros.launch.substitutions import (
        SomeText as _SomeSubstitutionsType,
        TextSubstitution as TextSubstitution,
    )
    from launch.logging import handlers as handlers

    SomeSubstitutionsType = _SomeSubstitutionsType
    LaunchConfig: Any
    LaunchLogger: Any
    expose_substitution: Any
    get_output_loggers: Any
    launch_config: Any
    log_launch_config: Any
    reset: Any
else:
    _LATE_NAMES = {
        "LaunchConfig": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "LaunchLogger": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "SomeSubstitutionsType": "kit.ros.launch.substitutions:SomeText",
        "TextSubstitution": "kit.ros.launch.substitutions:TextSubstitution",
        "expose_substitution": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "get_logger": "kit.ros.launch.log:get_logger",
        "get_output_loggers": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "handlers": "launch.logging.handlers",
        "launch_config": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "log_launch_config": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "reset": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
