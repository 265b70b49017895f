"""tf2_ros.buffer_client of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.msg.geometry_msgs import TransformStamped as TransformStamped
    from kit.msg.tf2_msgs import LookupTransform as LookupTransform
    from kit.ros.action.client import ActionClient as ActionClient
    from kit.ros.node.clock import Clock as Clock
    from kit.ros.node.node import Node as Node
    from kit.ros.node.time import Duration as Duration, Time as Time
    from time import sleep as sleep
    BufferClient: Any
    LookupTransformGoal: Any
    LookupTransformResult: Any
else:
    _LATE_NAMES = {
        "ActionClient": "kit.ros.action.client:ActionClient",
        "BufferClient": "!the C++ side of tf2_ros, in whose place the kit has Buffer and TransformListener",
        "Clock": "kit.ros.node.clock:Clock",
        "Duration": "kit.ros.node.time:Duration",
        "LookupTransform": "kit.msg.tf2_msgs:LookupTransform",
        "LookupTransformGoal": "!the C++ side of tf2_ros, in whose place the kit has Buffer and TransformListener",
        "LookupTransformResult": "!the C++ side of tf2_ros, in whose place the kit has Buffer and TransformListener",
        "Node": "kit.ros.node.node:Node",
        "Time": "kit.ros.node.time:Time",
        "TransformStamped": "kit.msg.geometry_msgs:TransformStamped",
        "sleep": "time:sleep",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
