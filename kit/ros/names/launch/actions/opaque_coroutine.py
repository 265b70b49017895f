"""launch.actions.opaque_coroutine of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.actions import OpaqueCoroutine as OpaqueCoroutine
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.entity import Action as Action, LaunchDescriptionEntity as LaunchDescriptionEntity
    from kit.ros.launch.event_handlers import OnShutdown as OnShutdown
    from kit.ros.launch.events import Event as Event
    from kit.ros.launch.normalization import (
        SomeEntities as _SomeActionsType,
        SomeEntities as _SomeEntitiesType,
        ensure_argument_type as ensure_argument_type,
    )

    SomeActionsType = _SomeActionsType
    SomeEntitiesType = _SomeEntitiesType
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "Event": "kit.ros.launch.events:Event",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "LaunchDescriptionEntity": "kit.ros.launch.entity:LaunchDescriptionEntity",
        "OnShutdown": "kit.ros.launch.event_handlers:OnShutdown",
        "OpaqueCoroutine": "kit.ros.launch.actions:OpaqueCoroutine",
        "SomeActionsType": "kit.ros.launch.normalization:SomeEntities",
        "SomeEntitiesType": "kit.ros.launch.normalization:SomeEntities",
        "ensure_argument_type": "kit.ros.launch.normalization:ensure_argument_type",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
