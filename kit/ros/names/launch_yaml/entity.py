"""launch_yaml.entity of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    AllowedTypesType: Any
    AllowedValueType: Any
    BaseEntity: Any
    Entity: Any
    check_is_list_entity: Any
    is_instance_of: Any
else:
    _LATE_NAMES = {
        "AllowedTypesType": "!launch's own reader of YAML files; `kit launch FILE` reads them",
        "AllowedValueType": "!launch's own reader of YAML files; `kit launch FILE` reads them",
        "BaseEntity": "!launch's own reader of YAML files; `kit launch FILE` reads them",
        "Entity": "!launch's own reader of YAML files; `kit launch FILE` reads them",
        "check_is_list_entity": "!launch's own reader of YAML files; `kit launch FILE` reads them",
        "is_instance_of": "!launch's own reader of YAML files; `kit launch FILE` reads them",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
