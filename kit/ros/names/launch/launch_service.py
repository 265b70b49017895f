"""launch.launch_service of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.entity import (
        LaunchDescription as LaunchDescription,
        LaunchDescriptionEntity as LaunchDescriptionEntity,
    )
    from kit.ros.launch.event_handlers import OnShutdown as OnShutdown
    from kit.ros.launch.events import (
        Event as Event,
        IncludeLaunchDescription as IncludeLaunchDescription,
        Shutdown as Shutdown,
    )
    from kit.ros.launch.normalization import SomeEntities as _SomeActionsType, SomeEntities as _SomeEntitiesType

    SomeActionsType = _SomeActionsType
    SomeEntitiesType = _SomeEntitiesType
    AsyncSafeSignalManager: Any
    LaunchService: Any
    OnIncludeLaunchDescription: Any
    visit_all_entities_and_collect_futures: Any
else:
    _LATE_NAMES = {
        "AsyncSafeSignalManager": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "Event": "kit.ros.launch.events:Event",
        "IncludeLaunchDescription": "kit.ros.launch.events:IncludeLaunchDescription",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "LaunchDescription": "kit.ros.launch.entity:LaunchDescription",
        "LaunchDescriptionEntity": "kit.ros.launch.entity:LaunchDescriptionEntity",
        "LaunchService": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "OnIncludeLaunchDescription": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "OnShutdown": "kit.ros.launch.event_handlers:OnShutdown",
        "Shutdown": "kit.ros.launch.events:Shutdown",
        "SomeActionsType": "kit.ros.launch.normalization:SomeEntities",
        "SomeEntitiesType": "kit.ros.launch.normalization:SomeEntities",
        "visit_all_entities_and_collect_futures": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
