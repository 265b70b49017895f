from kit.ros.lifecycle.node import LifecycleNode, LifecycleNodeMixin
from kit.ros.lifecycle.state_machine import LifecycleState, TransitionCallbackReturn

__all__ = ["LifecycleNode", "LifecycleNodeMixin", "LifecycleState", "TransitionCallbackReturn"]
