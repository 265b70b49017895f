import os

from launch import LaunchDescription
from launch.actions import (
    DeclareLaunchArgument,
    EmitEvent,
    ExecuteProcess,
    LogInfo,
    RegisterEventHandler,
    SetEnvironmentVariable,
    TimerAction,
)
from launch.conditions import IfCondition
from launch.event_handlers import OnProcessExit, OnProcessStart, OnShutdown
from launch.events import Shutdown
from launch.substitutions import EnvironmentVariable, LaunchConfiguration, PythonExpression

HERE = os.path.dirname(os.path.realpath(__file__))


def generate_launch_description():
    leg = os.path.join(HERE, "one_leg.py")
    first = ExecuteProcess(cmd=["python3", leg, LaunchConfiguration("speed"), "2.0", "first"], output="screen")
    second = ExecuteProcess(
        cmd=["python3", leg, LaunchConfiguration("speed"), PythonExpression(["2 * ", LaunchConfiguration("span")]),
             EnvironmentVariable("LEG_NAME")],
        output="screen",
    )
    never = ExecuteProcess(cmd=["python3", leg, "1.0", "5.0", "never"], condition=IfCondition(LaunchConfiguration("third")))
    return LaunchDescription([
        DeclareLaunchArgument("speed", default_value="0.2", description="forward speed"),
        DeclareLaunchArgument("span", default_value="1.5"),
        DeclareLaunchArgument("third", default_value="false"),
        SetEnvironmentVariable("LEG_NAME", "second"),
        TimerAction(period=3.0, actions=[LogInfo(msg="three seconds"), first]),
        RegisterEventHandler(OnProcessStart(target_action=first, on_start=[LogInfo(msg="the first leg starts")])),
        RegisterEventHandler(OnProcessExit(target_action=first, on_exit=[second])),
        RegisterEventHandler(OnProcessExit(
            target_action=second,
            on_exit=[LogInfo(msg="both legs are driven"), EmitEvent(event=Shutdown(reason="the course is driven"))],
        )),
        RegisterEventHandler(OnShutdown(on_shutdown=[LogInfo(msg=["speed was ", LaunchConfiguration("speed")])])),
        never,
    ])
