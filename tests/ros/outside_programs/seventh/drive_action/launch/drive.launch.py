from launch import LaunchDescription
from launch.actions import RegisterEventHandler, Shutdown
from launch.event_handlers import OnProcessExit, OnProcessStart
from launch_ros.actions import Node


def generate_launch_description():
    server = Node(package='drive_action', executable='server', output='screen')
    client = Node(package='drive_action', executable='client', output='screen')
    return LaunchDescription([
        server,
        RegisterEventHandler(OnProcessStart(target_action=server, on_start=[client])),
        RegisterEventHandler(OnProcessExit(target_action=client, on_exit=lambda event, context: Shutdown(
            reason=f'client returned {event.returncode}'))),
    ])
