from kit.ros.lifecycle.managed_entity import LifecyclePublisher, ManagedEntity, SimpleManagedEntity
from kit.ros.lifecycle.node import LifecycleNode, LifecycleNodeMixin
from kit.ros.lifecycle.state_machine import LifecycleState, TransitionCallbackReturn

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
