"""rclpy.subscription of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name
from kit.ros.node.subscription import MessageInfo, Subscription

__all__ = ["MessageInfo", "Subscription"]

if TYPE_CHECKING:
    from enum import Enum as Enum
    from kit.ros.execution.callback_groups import CallbackGroup as CallbackGroup
    from kit.ros.node.events import (
        EventHandler as EventHandler,
        EventHandler as _QoSEventHandler,
        SubscriptionEventCallbacks as SubscriptionEventCallbacks,
    )
    from kit.ros.node.qos import QoSProfile as QoSProfile
    from kit.ros.type_support import MsgT as MsgT, MsgT as MsgType

    QoSEventHandler = _QoSEventHandler
else:
    _LATE_NAMES = {
        "CallbackGroup": "kit.ros.execution.callback_groups:CallbackGroup",
        "Enum": "enum:Enum",
        "EventHandler": "kit.ros.node.events:EventHandler",
        "MsgT": "kit.ros.type_support:MsgT",
        "MsgType": "kit.ros.type_support:MsgT",
        "QoSEventHandler": "kit.ros.node.events:EventHandler",
        "QoSProfile": "kit.ros.node.qos:QoSProfile",
        "SubscriptionEventCallbacks": "kit.ros.node.events:SubscriptionEventCallbacks",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
