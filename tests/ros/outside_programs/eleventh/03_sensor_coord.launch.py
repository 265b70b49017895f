import math
import os

from launch import LaunchDescription
from launch.actions import EmitEvent, ExecuteProcess, RegisterEventHandler
from launch.event_handlers import OnProcessExit
from launch.events import Shutdown
from launch_ros.actions import Node

HERE = os.path.dirname(os.path.realpath(__file__))


def generate_launch_description():
    points = ExecuteProcess(
        cmd=['python3', os.path.join(HERE, 'sensor_points.py'), '--ros-args', '-r', '__ns:=/'], output='screen')
    return LaunchDescription([
        Node(
            package='tf2_ros', executable='static_transform_publisher', name='robot_in_world',
            arguments=['--x', '5', '--y', '3', '--yaw', str(math.radians(135)),
                       '--frame-id', 'world', '--child-frame-id', 'robot']),
        Node(
            package='tf2_ros', executable='static_transform_publisher', name='sensor_in_robot',
            arguments=['-1', '0', '0', str(math.pi), '0', '0', 'robot', 'sensor']),
        ExecuteProcess(cmd=['python3', os.path.join(HERE, 'sensor_transformer.py')], output='screen'),
        points,
        RegisterEventHandler(OnProcessExit(
            target_action=points,
            on_exit=[EmitEvent(event=Shutdown(reason='all points seen'))])),
    ])
