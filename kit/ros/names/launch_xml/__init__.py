"""launch_xml of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from launch_xml import launch_description_sources as launch_description_sources
    Entity: Any
    Parser: Any
else:
    _LATE_NAMES = {
        "Entity": "!launch's own reader of XML files; `kit launch FILE` reads them",
        "Parser": "!launch's own reader of XML files; `kit launch FILE` reads them",
        "launch_description_sources": "launch_xml.launch_description_sources",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
