"""Arguments, condition, namespaces, remap, YAML, events: the listener hears only what it should; all ends with the talker."""
from launch import LaunchDescription
from launch.actions import (DeclareLaunchArgument, EmitEvent, GroupAction, LogInfo, RegisterEventHandler, TimerAction)
from launch.conditions import IfCondition, UnlessCondition
from launch.event_handlers import OnProcessExit, OnProcessStart
from launch.events import Shutdown
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution, PythonExpression
from launch_ros.actions import Node, PushRosNamespace
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    extra = LaunchConfiguration("extra")
    east = Node(package="shop", executable="talker", name="talker",
                parameters=[PathJoinSubstitution([FindPackageShare("shop"), "config", "talker.yaml"]), {"limit": 3}],
                remappings=[("chatter", "/news")])
    late = Node(package="shop", executable="talker", name="late", parameters=[{"word": "late", "period": 0.5, "limit": PythonExpression(["1 + ", LaunchConfiguration("count")])}],
                remappings=[("chatter", "/news")])
    return LaunchDescription([
        DeclareLaunchArgument("extra", default_value="false", choices=["true", "false"]),
        DeclareLaunchArgument("count", default_value="1", description="words more"),
        Node(package="shop", executable="listener", remappings=[("chatter", "/news")], output="screen"),
        GroupAction([PushRosNamespace("east"), east]),
        LogInfo(msg="extra is on", condition=IfCondition(extra)),
        LogInfo(msg=["extra is off, count ", LaunchConfiguration("count")], condition=UnlessCondition(extra)),
        RegisterEventHandler(OnProcessStart(target_action=east, on_start=[LogInfo(msg="east started")])),
        RegisterEventHandler(OnProcessExit(target_action=east, on_exit=[LogInfo(msg="east ended"), TimerAction(period=1.0, actions=[late])])),
        RegisterEventHandler(OnProcessExit(target_action=late, on_exit=[EmitEvent(event=Shutdown(reason="all said"))])),
    ])
