"""rclpy.callback_groups of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.execution.callback_groups import (
    CallbackGroup,
    MutuallyExclusiveCallbackGroup,
    ReentrantCallbackGroup,
)
from kit.ros.late_names import import_late_name

__all__ = ["CallbackGroup", "MutuallyExclusiveCallbackGroup", "ReentrantCallbackGroup"]

if TYPE_CHECKING:
    from kit.ros.node.client import Client as Client
    from kit.ros.node.service import Service as Service
    from kit.ros.node.subscription import Subscription as Subscription
    from kit.ros.node.timer import Timer as Timer
    from kit.ros.node.waitable import Waitable as Waitable, WaitableGuardCondition as _GuardCondition
    from threading import Lock as Lock

    GuardCondition = _GuardCondition
    Entity: Any
else:
    _LATE_NAMES = {
        "Client": "kit.ros.node.client:Client",
        "Entity": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "GuardCondition": "kit.ros.node.waitable:WaitableGuardCondition",
        "Lock": "threading:Lock",
        "Service": "kit.ros.node.service:Service",
        "Subscription": "kit.ros.node.subscription:Subscription",
        "Timer": "kit.ros.node.timer:Timer",
        "Waitable": "kit.ros.node.waitable:Waitable",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
