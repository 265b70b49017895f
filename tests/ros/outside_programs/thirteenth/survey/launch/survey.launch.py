import os

import yaml
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, LogInfo, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node, PushRosNamespace


def stations(context):
    with open(LaunchConfiguration('config').perform(context), encoding='utf-8') as file:
        config = yaml.safe_load(file)
    wanted = LaunchConfiguration('only').perform(context)
    actions = []
    for name, settings in config['stations'].items():
        if wanted not in ('', name):
            actions.append(LogInfo(msg=f'{name} is left out'))
            continue
        actions.append(GroupAction([
            PushRosNamespace(name),
            Node(package='survey', executable='station', parameters=[settings], output='screen'),
        ]))
    actions.append(Node(package='survey', executable='summary', parameters=[config['summary']], output='screen'))
    return actions


def generate_launch_description():
    share = get_package_share_directory('survey')
    return LaunchDescription([
        DeclareLaunchArgument('config', default_value=os.path.join(share, 'config', 'stations.yaml'),
                              description='which stations there are'),
        DeclareLaunchArgument('only', default_value='', description='a single station'),
        OpaqueFunction(function=stations),
    ])
