"""rclpy.service of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING

from kit.ros.late_names import import_late_name
from kit.ros.node.service import Service
from kit.ros.node.service_introspection import ServiceIntrospectionState

__all__ = ["Service", "ServiceIntrospectionState"]

if TYPE_CHECKING:
    from kit.ros.execution.callback_groups import CallbackGroup as CallbackGroup
    from kit.ros.node.clock import Clock as Clock
    from kit.ros.node.qos import QoSProfile as QoSProfile
    from kit.ros.type_support import (
        Srv as Srv,
        SrvEventT as SrvEventT,
        SrvRequestT as SrvRequestT,
        SrvRequestT as SrvTypeRequest,
        SrvResponseT as SrvResponseT,
        SrvResponseT as SrvTypeResponse,
        SrvT as SrvType,
    )
else:
    _LATE_NAMES = {
        "CallbackGroup": "kit.ros.execution.callback_groups:CallbackGroup",
        "Clock": "kit.ros.node.clock:Clock",
        "QoSProfile": "kit.ros.node.qos:QoSProfile",
        "Srv": "kit.ros.type_support:Srv",
        "SrvEventT": "kit.ros.type_support:SrvEventT",
        "SrvRequestT": "kit.ros.type_support:SrvRequestT",
        "SrvResponseT": "kit.ros.type_support:SrvResponseT",
        "SrvType": "kit.ros.type_support:SrvT",
        "SrvTypeRequest": "kit.ros.type_support:SrvRequestT",
        "SrvTypeResponse": "kit.ros.type_support:SrvResponseT",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
