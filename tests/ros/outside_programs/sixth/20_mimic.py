"""The turtlesim mimic of the launch tutorial with a square driver: two sims in namespaces, a bag of poses, an include."""
import os
import sys
from launch import LaunchDescription
from launch.actions import ExecuteProcess, SetEnvironmentVariable, LogInfo, TimerAction, OpaqueFunction
from launch.substitutions import EnvironmentVariable, ThisLaunchFileDir
from launch_ros.actions import Node


def say(context, *args, **kwargs):
    return [LogInfo(msg="opaque sees " + context.environment.get("LAB", "nothing"))]


def generate_launch_description():
    return LaunchDescription([
        SetEnvironmentVariable("LAB", "seven"),
        Node(package="turtlesim", namespace="turtlesim1", executable="turtlesim_node", name="sim"),
        Node(package="turtlesim", namespace="turtlesim2", executable="turtlesim_node", name="sim"),
        Node(package="turtlesim", executable="mimic", name="mimic", remappings=[
            ("/input/pose", "/turtlesim1/turtle1/pose"), ("/output/cmd_vel", "/turtlesim2/turtle1/cmd_vel")]),
        LogInfo(msg=["lab ", EnvironmentVariable("LAB"), " ", EnvironmentVariable("NOPE", default_value="none")]),
        OpaqueFunction(function=say),
        TimerAction(period=1.0, actions=[ExecuteProcess(
            cmd=["ros2", "topic", "pub", "-r", "2", "-t", "6", "/turtlesim1/turtle1/cmd_vel", "geometry_msgs/msg/Twist",
                 '{linear: {x: 1.0}, angular: {z: 0.9}}'], output="screen")]),
        TimerAction(period=6.0, actions=[ExecuteProcess(cmd=["ros2", "topic", "echo", "--once", "/turtlesim2/turtle1/pose"], output="screen")]),
    ])
