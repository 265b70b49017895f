"""tf2_ros.buffer_interface of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name
from kit.ros.tf_conversion import (
    BufferInterface,
    ConvertRegistration,
    NotImplementedException,
    TransformRegistration,
    TypeException,
    convert,
)

__all__ = [
    "BufferInterface",
    "ConvertRegistration",
    "NotImplementedException",
    "TransformRegistration",
    "TypeException",
    "convert",
]

if TYPE_CHECKING:
    from copy import deepcopy as deepcopy
    from kit.msg.geometry_msgs import (
        PointStamped as PointStamped,
        PoseStamped as PoseStamped,
        PoseWithCovarianceStamped as PoseWithCovarianceStamped,
        TransformStamped as TransformStamped,
        Vector3Stamped as Vector3Stamped,
    )
    from kit.msg.sensor_msgs import PointCloud2 as PointCloud2
    from kit.msg.std_msgs import Header as Header
    from kit.ros.node.time import Duration as Duration, Time as Time
    from typing import Any as _MsgStamped, Any as _TransformableObject, Any as _TransformableObjectType

    MsgStamped = _MsgStamped
    TransformableObject = _TransformableObject
    TransformableObjectType = _TransformableObjectType
    PyKDLType: Any
    Stamped: Any
else:
    _LATE_NAMES = {
        "Duration": "kit.ros.node.time:Duration",
        "Header": "kit.msg.std_msgs:Header",
        "MsgStamped": "typing:Any",
        "PointCloud2": "kit.msg.sensor_msgs:PointCloud2",
        "PointStamped": "kit.msg.geometry_msgs:PointStamped",
        "PoseStamped": "kit.msg.geometry_msgs:PoseStamped",
        "PoseWithCovarianceStamped": "kit.msg.geometry_msgs:PoseWithCovarianceStamped",
        "PyKDLType": "!the C++ side of tf2_ros, in whose place the kit has Buffer and TransformListener",
        "Stamped": "!the C++ side of tf2_ros, in whose place the kit has Buffer and TransformListener",
        "Time": "kit.ros.node.time:Time",
        "TransformStamped": "kit.msg.geometry_msgs:TransformStamped",
        "TransformableObject": "typing:Any",
        "TransformableObjectType": "typing:Any",
        "Vector3Stamped": "kit.msg.geometry_msgs:Vector3Stamped",
        "deepcopy": "copy:deepcopy",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
