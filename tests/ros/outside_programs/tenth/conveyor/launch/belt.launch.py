from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def belts(context):
    weights = [int(w) for w in LaunchConfiguration('weights').perform(context).split('+')]
    return [Node(package='conveyor', executable='belt',
                 parameters=[{'weights': weights,
                              'period': float(context.launch_configurations['period']),
                              'label': LaunchConfiguration('label')}],
                 remappings=[('unused', 'other')])]


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('weights', description='weights joined by +'),
        DeclareLaunchArgument('period', default_value='0.5'),
        DeclareLaunchArgument('label', default_value='plain', choices=['plain', 'red', 'blue']),
        OpaqueFunction(function=belts),
    ])
