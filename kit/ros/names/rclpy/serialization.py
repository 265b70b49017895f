"""rclpy.serialization of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name
from kit.ros.serialization import deserialize_message, serialize_message

__all__ = ["deserialize_message", "serialize_message"]

if TYPE_CHECKING:
    from kit.ros.type_support import Msg as Msg, MsgT as MsgT, check_for_type_support as check_for_type_support
else:
    _LATE_NAMES = {
        "Msg": "kit.ros.type_support:Msg",
        "MsgT": "kit.ros.type_support:MsgT",
        "check_for_type_support": "kit.ros.type_support:check_for_type_support",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
