"""rclpy.lifecycle of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name
from kit.ros.lifecycle import (
    LifecycleNode,
    LifecycleNode as _Node,
    LifecycleNodeMixin as LifecycleMixin,
    LifecycleNodeMixin,
    LifecyclePublisher,
    LifecyclePublisher as _Publisher,
    LifecycleState,
    LifecycleState as _State,
    ManagedEntity,
    SimpleManagedEntity,
    TransitionCallbackReturn,
)

Node = _Node
Publisher = _Publisher
State = _State

__all__ = [
    "LifecycleMixin",
    "LifecycleNode",
    "LifecycleNodeMixin",
    "LifecyclePublisher",
    "LifecycleState",
    "ManagedEntity",
    "SimpleManagedEntity",
    "TransitionCallbackReturn",
]

if TYPE_CHECKING:
    NodeMixin: Any
else:
    _LATE_NAMES = {
        "NodeMixin": "!rclpy's library in C, in whose place the kit has a graph of its own",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
