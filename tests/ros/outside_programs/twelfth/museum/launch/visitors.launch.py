from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def launch_setup(context):
    count = int(LaunchConfiguration('count').perform(context))
    return [
        Node(
            package='museum', executable='visitor', name=f'visitor_{number}',
            parameters=[{'number': ParameterValue(str(number), value_type=int)}], output='screen')
        for number in range(count)
    ]


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('count', default_value='1'),
        OpaqueFunction(function=launch_setup),
    ])
