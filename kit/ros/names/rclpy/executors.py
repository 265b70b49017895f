"""rclpy.executors of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.execution.executors import (
    ConditionReachedException,
    Executor,
    ExternalShutdownException,
    MultiThreadedExecutor,
    ShutdownException,
    SingleThreadedExecutor,
    TimeoutException,
)
from kit.ros.execution.task import await_or_execute
from kit.ros.late_names import import_late_name

__all__ = [
    "ConditionReachedException",
    "Executor",
    "ExternalShutdownException",
    "MultiThreadedExecutor",
    "ShutdownException",
    "SingleThreadedExecutor",
    "TimeoutException",
    "await_or_execute",
]

if TYPE_CHECKING:
    from concurrent.futures import ThreadPoolExecutor as ThreadPoolExecutor
    from contextlib import ExitStack as ExitStack
    from functools import partial as partial
    from kit.ros.exceptions import InvalidHandle as InvalidHandle
    from kit.ros.execution.client_library import timeout_sec_to_nsec as timeout_sec_to_nsec
    from kit.ros.execution.context import Context as Context, get_default_context as get_default_context
    from kit.ros.execution.task import Future as Future, Task as Task
    from kit.ros.launch.entity import Condition as Condition
    from kit.ros.node.client import Client as Client
    from kit.ros.node.clock import Clock as Clock
    from kit.ros.node.node import Node as Node
    from kit.ros.node.service import Service as Service
    from kit.ros.node.subscription import Subscription as Subscription
    from kit.ros.node.time import ClockType as ClockType
    from kit.ros.node.timer import Timer as Timer, TimerInfo as TimerInfo
    from kit.ros.node.waitable import (
        NumberOfEntities as NumberOfEntities,
        Waitable as Waitable,
        WaitableGuardCondition as _GuardCondition,
    )
    from threading import Lock as Lock, RLock as RLock

    GuardCondition = _GuardCondition
    SignalHandlerGuardCondition: Any
    TimeoutObject: Any
    WaitableEntityType: Any
else:
    _LATE_NAMES = {
        "Client": "kit.ros.node.client:Client",
        "Clock": "kit.ros.node.clock:Clock",
        "ClockType": "kit.ros.node.time:ClockType",
        "Condition": "kit.ros.launch.entity:Condition",
        "Context": "kit.ros.execution.context:Context",
        "ExitStack": "contextlib:ExitStack",
        "Future": "kit.ros.execution.task:Future",
        "GuardCondition": "kit.ros.node.waitable:WaitableGuardCondition",
        "InvalidHandle": "kit.ros.exceptions:InvalidHandle",
        "Lock": "threading:Lock",
        "Node": "kit.ros.node.node:Node",
        "NumberOfEntities": "kit.ros.node.waitable:NumberOfEntities",
        "RLock": "threading:RLock",
        "Service": "kit.ros.node.service:Service",
        "SignalHandlerGuardCondition": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "Subscription": "kit.ros.node.subscription:Subscription",
        "Task": "kit.ros.execution.task:Task",
        "ThreadPoolExecutor": "concurrent.futures:ThreadPoolExecutor",
        "TimeoutObject": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "Timer": "kit.ros.node.timer:Timer",
        "TimerInfo": "kit.ros.node.timer:TimerInfo",
        "Waitable": "kit.ros.node.waitable:Waitable",
        "WaitableEntityType": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "get_default_context": "kit.ros.execution.context:get_default_context",
        "partial": "functools:partial",
        "timeout_sec_to_nsec": "kit.ros.execution.client_library:timeout_sec_to_nsec",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
