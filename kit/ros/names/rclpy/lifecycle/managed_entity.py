"""rclpy.lifecycle.managed_entity of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name
from kit.ros.lifecycle import ManagedEntity, SimpleManagedEntity

__all__ = ["ManagedEntity", "SimpleManagedEntity"]

if TYPE_CHECKING:
    from functools import wraps as wraps
    from kit.ros.lifecycle import (
        LifecycleState as LifecycleState,
        TransitionCallbackReturn as TransitionCallbackReturn,
    )
else:
    _LATE_NAMES = {
        "LifecycleState": "kit.ros.lifecycle:LifecycleState",
        "TransitionCallbackReturn": "kit.ros.lifecycle:TransitionCallbackReturn",
        "wraps": "functools:wraps",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
