"""tf2_ros.transform_broadcaster of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name
from kit.ros.tf import TransformBroadcaster

__all__ = ["TransformBroadcaster"]

if TYPE_CHECKING:
    from kit.msg.geometry_msgs import TransformStamped as TransformStamped
    from kit.msg.tf2_msgs import TFMessage as TFMessage
    from kit.ros.node.node import Node as Node
    from kit.ros.node.qos import QoSProfile as QoSProfile
else:
    _LATE_NAMES = {
        "Node": "kit.ros.node.node:Node",
        "QoSProfile": "kit.ros.node.qos:QoSProfile",
        "TFMessage": "kit.msg.tf2_msgs:TFMessage",
        "TransformStamped": "kit.msg.geometry_msgs:TransformStamped",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
