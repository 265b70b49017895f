"""rclpy.lifecycle.node of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name
from kit.ros.lifecycle import LifecycleNode, LifecycleNodeMixin, LifecycleState, TransitionCallbackReturn

__all__ = ["LifecycleNode", "LifecycleNodeMixin", "LifecycleState", "TransitionCallbackReturn"]

if TYPE_CHECKING:
    from kit.ros.execution.callback_groups import CallbackGroup as CallbackGroup
    from kit.ros.execution.context import Context as Context
    from kit.ros.lifecycle import LifecyclePublisher as LifecyclePublisher, ManagedEntity as ManagedEntity
    from kit.ros.node.events import PublisherEventCallbacks as PublisherEventCallbacks
    from kit.ros.node.node import Node as Node
    from kit.ros.node.qos import QoSProfile as QoSProfile
    from kit.ros.node.qos_overrides import QoSOverridingOptions as QoSOverridingOptions
    from kit.ros.node.service import Service as Service
    from kit.ros.parameters.parameter import Parameter as Parameter
    from kit.ros.type_support import MsgT as MsgT, check_is_valid_srv_type as check_is_valid_srv_type
    CallbackNames: Any
    CreateLifecyclePublisherArgs: Any
    LifecycleNodeArgs: Any
else:
    _LATE_NAMES = {
        "CallbackGroup": "kit.ros.execution.callback_groups:CallbackGroup",
        "CallbackNames": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "Context": "kit.ros.execution.context:Context",
        "CreateLifecyclePublisherArgs": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "LifecycleNodeArgs": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "LifecyclePublisher": "kit.ros.lifecycle:LifecyclePublisher",
        "ManagedEntity": "kit.ros.lifecycle:ManagedEntity",
        "MsgT": "kit.ros.type_support:MsgT",
        "Node": "kit.ros.node.node:Node",
        "Parameter": "kit.ros.parameters.parameter:Parameter",
        "PublisherEventCallbacks": "kit.ros.node.events:PublisherEventCallbacks",
        "QoSOverridingOptions": "kit.ros.node.qos_overrides:QoSOverridingOptions",
        "QoSProfile": "kit.ros.node.qos:QoSProfile",
        "Service": "kit.ros.node.service:Service",
        "check_is_valid_srv_type": "kit.ros.type_support:check_is_valid_srv_type",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
