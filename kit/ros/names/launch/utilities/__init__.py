"""launch.utilities of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.ros.launch.normalization import (
        ensure_argument_type as ensure_argument_type,
        is_a as is_a,
        is_a as _isclassinstance,
        is_a_subclass as is_a_subclass,
        normalize_to_list_of_entities as normalize_to_list_of_entities,
        normalize_to_list_of_substitutions as normalize_to_list_of_substitutions,
        perform as _perform_substitutions,
    )

    isclassinstance = _isclassinstance
    perform_substitutions = _perform_substitutions
    AsyncSafeSignalManager: Any
    create_future: Any
    visit_all_entities_and_collect_futures: Any
else:
    _LATE_NAMES = {
        "AsyncSafeSignalManager": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "create_future": "!launch's own process, in whose place `kit launch FILE` runs launch files",
        "ensure_argument_type": "kit.ros.launch.normalization:ensure_argument_type",
        "is_a": "kit.ros.launch.normalization:is_a",
        "is_a_subclass": "kit.ros.launch.normalization:is_a_subclass",
        "isclassinstance": "kit.ros.launch.normalization:is_a",
        "normalize_to_list_of_entities": "kit.ros.launch.normalization:normalize_to_list_of_entities",
        "normalize_to_list_of_substitutions": "kit.ros.launch.normalization:normalize_to_list_of_substitutions",
        "perform_substitutions": "kit.ros.launch.normalization:perform",
        "visit_all_entities_and_collect_futures": "!launch's own process, in whose place `kit launch FILE` runs launch files",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
