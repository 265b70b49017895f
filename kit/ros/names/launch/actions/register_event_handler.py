"""launch.actions.register_event_handler of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.actions import RegisterEventHandler as RegisterEventHandler
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.entity import Action as Action, LaunchDescriptionEntity as LaunchDescriptionEntity
    from kit.ros.launch.event_handlers import EventHandler as _BaseEventHandler
    from kit.ros.launch.normalization import normalize_to_list_of_entities as normalize_to_list_of_entities

    BaseEventHandler = _BaseEventHandler
else:
    _LATE_NAMES = {
        "Action": "kit.ros.launch.entity:Action",
        "BaseEventHandler": "kit.ros.launch.event_handlers:EventHandler",
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "LaunchDescriptionEntity": "kit.ros.launch.entity:LaunchDescriptionEntity",
        "RegisterEventHandler": "kit.ros.launch.actions:RegisterEventHandler",
        "normalize_to_list_of_entities": "kit.ros.launch.normalization:normalize_to_list_of_entities",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
