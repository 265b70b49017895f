"""launch.event_handlers.on_shutdown of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.event_handlers import EventHandler as _BaseEventHandler, OnShutdown as OnShutdown
    from kit.ros.launch.events import Event as Event, Shutdown as Shutdown
    from kit.ros.launch.normalization import (
        SomeEntities as _SomeActionsType,
        SomeEntities as _SomeEntitiesType,
        is_a_subclass as is_a_subclass,
    )

    BaseEventHandler = _BaseEventHandler
    SomeActionsType = _SomeActionsType
    SomeEntitiesType = _SomeEntitiesType
    gen_handler: Any
else:
    _LATE_NAMES = {
        "BaseEventHandler": "kit.ros.launch.event_handlers:EventHandler",
        "Event": "kit.ros.launch.events:Event",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "OnShutdown": "kit.ros.launch.event_handlers:OnShutdown",
        "Shutdown": "kit.ros.launch.events:Shutdown",
        "SomeActionsType": "kit.ros.launch.normalization:SomeEntities",
        "SomeEntitiesType": "kit.ros.launch.normalization:SomeEntities",
        "gen_handler": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "is_a_subclass": "kit.ros.launch.normalization:is_a_subclass",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
