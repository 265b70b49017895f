"""launch_ros.actions of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.launch.actions import TimerAction as ROSTimer, TimerAction as RosTimer
from kit.ros.launch.processes import (
    ComposableNodeContainer,
    LifecycleNode,
    LifecycleTransition,
    LoadComposableNodes,
    Node,
    PushRosNamespace as PushROSNamespace,
    PushRosNamespace,
    SetParameter,
    SetParametersFromFile,
    SetROSLogDir,
    SetRemap,
    SetUseSimTime,
)

__all__ = [
    "ComposableNodeContainer",
    "LifecycleNode",
    "LifecycleTransition",
    "LoadComposableNodes",
    "Node",
    "PushROSNamespace",
    "PushRosNamespace",
    "ROSTimer",
    "RosTimer",
    "SetParameter",
    "SetParametersFromFile",
    "SetROSLogDir",
    "SetRemap",
    "SetUseSimTime",
]
