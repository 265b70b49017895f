from kit.ros.lifecycle import (
    LifecycleNode,
    LifecycleNodeMixin,
    LifecyclePublisher,
    LifecycleState,
    ManagedEntity,
    SimpleManagedEntity,
    TransitionCallbackReturn,
)

# Not in __all__, as in ROS 2, so that they are not taken for the ones of rclpy.node and rclpy.publisher.
LifecycleMixin = LifecycleNodeMixin
Node = LifecycleNode
State = LifecycleState
Publisher = LifecyclePublisher

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
