"""rclpy.time_source of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    from kit.msg.rcl_interfaces import SetParametersResult as SetParametersResult
    from kit.ros.constants import CLOCK_TOPIC as CLOCK_TOPIC, USE_SIM_TIME_NAME as USE_SIM_TIME_NAME
    from kit.ros.node.clock import ROSClock as ROSClock
    from kit.ros.node.node import Node as Node
    from kit.ros.node.qos import QoSProfile as QoSProfile, ReliabilityPolicy as ReliabilityPolicy
    from kit.ros.node.subscription import Subscription as Subscription
    from kit.ros.node.time import ClockType as ClockType, Time as Time
    from kit.ros.parameters.parameter import Parameter as Parameter
    TimeSource: Any
else:
    _LATE_NAMES = {
        "CLOCK_TOPIC": "kit.ros.constants:CLOCK_TOPIC",
        "ClockType": "kit.ros.node.time:ClockType",
        "Node": "kit.ros.node.node:Node",
        "Parameter": "kit.ros.parameters.parameter:Parameter",
        "QoSProfile": "kit.ros.node.qos:QoSProfile",
        "ROSClock": "kit.ros.node.clock:ROSClock",
        "ReliabilityPolicy": "kit.ros.node.qos:ReliabilityPolicy",
        "SetParametersResult": "kit.msg.rcl_interfaces:SetParametersResult",
        "Subscription": "kit.ros.node.subscription:Subscription",
        "Time": "kit.ros.node.time:Time",
        "TimeSource": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "USE_SIM_TIME_NAME": "kit.ros.constants:USE_SIM_TIME_NAME",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
