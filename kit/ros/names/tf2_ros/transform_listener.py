"""tf2_ros.transform_listener of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name
from kit.ros.tf import TransformListener

__all__ = ["TransformListener"]

if TYPE_CHECKING:
    from kit.msg.tf2_msgs import TFMessage as TFMessage
    from kit.ros.constants import STATIC_TF_TOPIC as _DEFAULT_STATIC_TF_TOPIC, TF_TOPIC as _DEFAULT_TF_TOPIC
    from kit.ros.execution.callback_groups import ReentrantCallbackGroup as ReentrantCallbackGroup
    from kit.ros.execution.executors import SingleThreadedExecutor as SingleThreadedExecutor
    from kit.ros.node.node import Node as Node
    from kit.ros.node.qos import (
        DurabilityPolicy as DurabilityPolicy,
        HistoryPolicy as HistoryPolicy,
        QoSProfile as QoSProfile,
    )
    from kit.ros.tf import Buffer as Buffer
    from threading import Thread as Thread

    DEFAULT_STATIC_TF_TOPIC = _DEFAULT_STATIC_TF_TOPIC
    DEFAULT_TF_TOPIC = _DEFAULT_TF_TOPIC
else:
    _LATE_NAMES = {
        "Buffer": "kit.ros.tf:Buffer",
        "DEFAULT_STATIC_TF_TOPIC": "kit.ros.constants:STATIC_TF_TOPIC",
        "DEFAULT_TF_TOPIC": "kit.ros.constants:TF_TOPIC",
        "DurabilityPolicy": "kit.ros.node.qos:DurabilityPolicy",
        "HistoryPolicy": "kit.ros.node.qos:HistoryPolicy",
        "Node": "kit.ros.node.node:Node",
        "QoSProfile": "kit.ros.node.qos:QoSProfile",
        "ReentrantCallbackGroup": "kit.ros.execution.callback_groups:ReentrantCallbackGroup",
        "SingleThreadedExecutor": "kit.ros.execution.executors:SingleThreadedExecutor",
        "TFMessage": "kit.msg.tf2_msgs:TFMessage",
        "Thread": "threading:Thread",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
