"""launch.frontend.entity of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    AllowedTypesType: Any
    AllowedValueType: Any
    Entity: Any
    TargetType: Any
else:
    _LATE_NAMES = {
        "AllowedTypesType": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "AllowedValueType": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "Entity": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "TargetType": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
