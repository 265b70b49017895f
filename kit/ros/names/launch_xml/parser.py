"""launch_xml.parser of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    Entity: Any
    Parser: Any
    frontend: Any
else:
    _LATE_NAMES = {
        "Entity": "!launch's own reader of XML files; `kit launch FILE` reads them",
        "Parser": "!launch's own reader of XML files; `kit launch FILE` reads them",
        "frontend": "!launch's own reader of XML files; `kit launch FILE` reads them",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
