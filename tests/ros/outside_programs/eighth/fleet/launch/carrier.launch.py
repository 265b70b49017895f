from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, LogInfo
from launch.conditions import LaunchConfigurationEquals
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    params = PathJoinSubstitution([FindPackageShare('fleet'), 'config', 'fleet.yaml'])
    return LaunchDescription([
        DeclareLaunchArgument('speed', default_value='slow', choices=['slow', 'fast']),
        LogInfo(msg=['a carrier that is ', LaunchConfiguration('speed')]),
        Node(
            package='fleet', executable='carrier', output='screen', parameters=[params],
            condition=LaunchConfigurationEquals('speed', 'slow'),
        ),
        Node(
            package='fleet', executable='carrier', output='screen', parameters=[params, {'period': 0.1}],
            condition=LaunchConfigurationEquals('speed', 'fast'),
        ),
    ])
