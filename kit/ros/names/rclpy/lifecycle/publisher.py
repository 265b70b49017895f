"""rclpy.lifecycle.publisher of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name
from kit.ros.lifecycle import LifecyclePublisher

__all__ = ["LifecyclePublisher"]

if TYPE_CHECKING:
    from kit.ros.execution.callback_groups import CallbackGroup as CallbackGroup
    from kit.ros.lifecycle import SimpleManagedEntity as SimpleManagedEntity
    from kit.ros.node.events import PublisherEventCallbacks as PublisherEventCallbacks
    from kit.ros.node.publisher import Publisher as Publisher
    from kit.ros.node.qos import QoSProfile as QoSProfile
    from kit.ros.type_support import MsgT as MsgT, MsgT as MsgType
    LifecyclePublisherArgs: Any
    LifecyclePublisherKWArgs: Any
else:
    _LATE_NAMES = {
        "CallbackGroup": "kit.ros.execution.callback_groups:CallbackGroup",
        "LifecyclePublisherArgs": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "LifecyclePublisherKWArgs": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "MsgT": "kit.ros.type_support:MsgT",
        "MsgType": "kit.ros.type_support:MsgT",
        "Publisher": "kit.ros.node.publisher:Publisher",
        "PublisherEventCallbacks": "kit.ros.node.events:PublisherEventCallbacks",
        "QoSProfile": "kit.ros.node.qos:QoSProfile",
        "SimpleManagedEntity": "kit.ros.lifecycle:SimpleManagedEntity",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
