"""rclpy.lifecycle of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

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
