import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import RegisterEventHandler, EmitEvent
from launch.event_handlers import OnProcessExit
from launch.events import Shutdown
from launch_ros.actions import Node


def generate_launch_description():
    config = os.path.join(get_package_share_directory('state_monitor'), 'config', 'monitor.yaml')
    monitor = Node(package='state_monitor', executable='monitor', parameters=[config], output='screen')
    sensors = [
        Node(package='state_monitor_sensors', executable='sensor', name=name, parameters=[config], output='screen')
        for name in ('lidar', 'camera')
    ]
    return LaunchDescription([
        monitor,
        Node(package='state_monitor', executable='error_handler', output='screen'),
        *sensors,
        RegisterEventHandler(OnProcessExit(target_action=monitor, on_exit=[EmitEvent(event=Shutdown())])),
    ])
