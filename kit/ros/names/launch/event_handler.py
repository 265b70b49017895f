"""launch.event_handler of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name
from kit.ros.launch.event_handlers import EventHandler

__all__ = ["EventHandler"]

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.event_handlers import EventHandler as _BaseEventHandler
    from kit.ros.launch.events import Event as Event
    from kit.ros.launch.normalization import SomeEntities as _SomeActionsType, SomeEntities as _SomeEntitiesType

    BaseEventHandler = _BaseEventHandler
    SomeActionsType = _SomeActionsType
    SomeEntitiesType = _SomeEntitiesType
else:
    _LATE_NAMES = {
        "BaseEventHandler": "kit.ros.launch.event_handlers:EventHandler",
        "Event": "kit.ros.launch.events:Event",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "SomeActionsType": "kit.ros.launch.normalization:SomeEntities",
        "SomeEntitiesType": "kit.ros.launch.normalization:SomeEntities",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
