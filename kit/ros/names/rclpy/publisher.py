"""rclpy.publisher of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name
from kit.ros.node.publisher import Publisher

__all__ = ["Publisher"]

if TYPE_CHECKING:
    from kit.ros.execution.callback_groups import CallbackGroup as CallbackGroup
    from kit.ros.node.events import (
        EventHandler as EventHandler,
        EventHandler as _QoSEventHandler,
        PublisherEventCallbacks as PublisherEventCallbacks,
    )
    from kit.ros.node.qos import QoSProfile as QoSProfile
    from kit.ros.node.time import Duration as Duration
    from kit.ros.type_support import MsgT as MsgT, MsgT as MsgType

    QoSEventHandler = _QoSEventHandler
else:
    _LATE_NAMES = {
        "CallbackGroup": "kit.ros.execution.callback_groups:CallbackGroup",
        "Duration": "kit.ros.node.time:Duration",
        "EventHandler": "kit.ros.node.events:EventHandler",
        "MsgT": "kit.ros.type_support:MsgT",
        "MsgType": "kit.ros.type_support:MsgT",
        "PublisherEventCallbacks": "kit.ros.node.events:PublisherEventCallbacks",
        "QoSEventHandler": "kit.ros.node.events:EventHandler",
        "QoSProfile": "kit.ros.node.qos:QoSProfile",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
