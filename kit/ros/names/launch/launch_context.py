"""launch.launch_context of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name
from kit.ros.launch.context import LaunchContext

__all__ = ["LaunchContext"]

if TYPE_CHECKING:
    from kit.ros.launch.event_handlers import EventHandler as _BaseEventHandler
    from kit.ros.launch.events import Event as Event
    from kit.ros.launch.substitutions import Substitution as Substitution

    BaseEventHandler = _BaseEventHandler
else:
    _LATE_NAMES = {
        "BaseEventHandler": "kit.ros.launch.event_handlers:EventHandler",
        "Event": "kit.ros.launch.events:Event",
        "Substitution": "kit.ros.launch.substitutions:Substitution",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
