"""tf2_ros.buffer of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name
from kit.ros.tf import Buffer

__all__ = ["Buffer"]

if TYPE_CHECKING:
    from kit.msg.geometry_msgs import TransformStamped as TransformStamped
    from kit.msg.tf2_msgs import FrameGraph as FrameGraph
    from kit.ros.execution.task import Future as Future
    from kit.ros.node.clock import JumpThreshold as JumpThreshold, TimeJump as TimeJump
    from kit.ros.node.node import Node as Node
    from kit.ros.node.time import Duration as Duration, Time as Time
    from time import sleep as sleep
    FrameGraphSrvRequest: Any
    FrameGraphSrvResponse: Any
else:
    _LATE_NAMES = {
        "Duration": "kit.ros.node.time:Duration",
        "FrameGraph": "kit.msg.tf2_msgs:FrameGraph",
        "FrameGraphSrvRequest": "!the C++ side of tf2_ros, in whose place the kit has Buffer and TransformListener",
        "FrameGraphSrvResponse": "!the C++ side of tf2_ros, in whose place the kit has Buffer and TransformListener",
        "Future": "kit.ros.execution.task:Future",
        "JumpThreshold": "kit.ros.node.clock:JumpThreshold",
        "Node": "kit.ros.node.node:Node",
        "Time": "kit.ros.node.time:Time",
        "TimeJump": "kit.ros.node.clock:TimeJump",
        "TransformStamped": "kit.msg.geometry_msgs:TransformStamped",
        "sleep": "time:sleep",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
