"""As many turtles as asked for, each with a node in its namespace, made by an opaque function."""

import math
import os

from launch import LaunchDescription
from launch.actions import (
    DeclareLaunchArgument,
    ExecuteProcess,
    GroupAction,
    LogInfo,
    OpaqueFunction,
    RegisterEventHandler,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
    Shutdown,
    TimerAction,
)
from launch.conditions import IfCondition, LaunchConfigurationEquals, UnlessCondition
from launch.event_handlers import OnProcessExit, OnShutdown
from launch.substitutions import (
    AndSubstitution,
    EqualsSubstitution,
    LaunchConfiguration,
    LocalSubstitution,
    NotSubstitution,
    PathJoinSubstitution,
    PythonExpression,
    ThisLaunchFileDir,
)
from launch_ros.actions import Node, PushRosNamespace, SetParameter, SetRemap

HERE = os.path.dirname(os.path.realpath(__file__))


def make_turtles(context, *args, **kwargs):
    count = int(LaunchConfiguration("count").perform(context))
    shape = context.launch_configurations["shape"]
    groups = []
    for i in range(count):
        angle = math.tau * i / count
        x, y = (5.5 + 3 * math.cos(angle), 5.5 + 3 * math.sin(angle)) if shape == "ring" else (1.0 + i, 1.0)
        spawn = ExecuteProcess(
            cmd=["ros2", "service", "call", "/spawn", "turtlesim/srv/Spawn",
                 f'"{{x: {x:.2f}, y: {y:.2f}, theta: 0.0, name: m{i}}}"'],
            shell=True,
            output="log",
        )
        walker = GroupAction(
            actions=[
                PushRosNamespace(f"m{i}"),
                SetRemap(src="velocity", dst="cmd_vel"),
                SetParameter(name="speed", value=0.5 + 0.25 * i),
                ExecuteProcess(
                    cmd=["python3", os.path.join(HERE, "walker.py"), "--ros-args", "-r", f"__ns:=/m{i}",
                         "-r", "velocity:=cmd_vel", "--params-file", os.path.join(HERE, "config", "walkers.yaml")],
                    output="screen",
                ),
            ]
        )
        groups += [spawn, RegisterEventHandler(OnProcessExit(target_action=spawn, on_exit=[walker]))]
    return [LogInfo(msg=f"{count} turtles in a {shape}"), *groups]


def generate_launch_description():
    count = LaunchConfiguration("count")
    turtlesim = Node(
        package="turtlesim", executable="turtlesim_node", name="sim", parameters=[{"background_r": 10}]
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument("count", default_value="2", description="How many turtles."),
            DeclareLaunchArgument("shape", default_value="ring", choices=["ring", "row"]),
            DeclareLaunchArgument("seconds", default_value="6.0"),
            SetLaunchConfiguration("many", PythonExpression(["int('", count, "') > 2"])),
            SetEnvironmentVariable("PARADE", ["of ", count]),
            LogInfo(msg=["many: ", LaunchConfiguration("many")], condition=IfCondition(LaunchConfiguration("many"))),
            LogInfo(msg="few", condition=UnlessCondition(LaunchConfiguration("many"))),
            LogInfo(msg="in a row", condition=LaunchConfigurationEquals("shape", "row")),
            LogInfo(
                msg="a big ring",
                condition=IfCondition(
                    AndSubstitution(EqualsSubstitution(LaunchConfiguration("shape"), "ring"), LaunchConfiguration("many"))
                ),
            ),
            LogInfo(msg=["files: ", PathJoinSubstitution([ThisLaunchFileDir(), "config"])]),
            turtlesim,
            OpaqueFunction(function=make_turtles),
            TimerAction(period=LaunchConfiguration("seconds"), actions=[Shutdown(reason="the parade is over")]),
            RegisterEventHandler(OnShutdown(on_shutdown=[LogInfo(msg=["because ", LocalSubstitution("event.reason")])])),
            LogInfo(msg="never", condition=IfCondition(NotSubstitution("true"))),
        ]
    )
