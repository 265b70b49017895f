"""launch.utilities.visit_all_entities_and_collect_futures_impl of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext as LaunchContext
    from kit.ros.launch.entity import LaunchDescriptionEntity as LaunchDescriptionEntity
    visit_all_entities_and_collect_futures: Any
else:
    _LATE_NAMES = {
        "LaunchContext": "kit.ros.launch.context:LaunchContext",
        "LaunchDescriptionEntity": "kit.ros.launch.entity:LaunchDescriptionEntity",
        "visit_all_entities_and_collect_futures": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
