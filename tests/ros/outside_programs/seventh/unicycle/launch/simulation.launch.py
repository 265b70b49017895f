from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterFile
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    params = ParameterFile(PathJoinSubstitution([FindPackageShare('unicycle'), 'config', 'params.yaml']), allow_substs=True)
    return LaunchDescription([
        DeclareLaunchArgument('watch', default_value='true', choices=['true', 'false']),
        Node(package='unicycle', executable='simulator', parameters=[params]),
        Node(package='unicycle', executable='controller', parameters=[params], output='screen'),
        Node(package='unicycle', executable='watcher', output={'both': 'screen'},
             condition=IfCondition(LaunchConfiguration('watch'))),
    ])
