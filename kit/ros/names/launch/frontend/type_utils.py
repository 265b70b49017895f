"""launch.frontend.type_utils of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    AllowedTypesType: Any
    Entity: Any
    check_is_list_entity: Any
    get_data_type_from_identifier: Any
    is_typing_list: Any
else:
    _LATE_NAMES = {
        "AllowedTypesType": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "Entity": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "check_is_list_entity": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "get_data_type_from_identifier": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "is_typing_list": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
