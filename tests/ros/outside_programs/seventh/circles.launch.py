import os
from launch import LaunchDescription
from launch.actions import ExecuteProcess
from launch_ros.actions import Node


def generate_launch_description():
    here = os.path.dirname(os.path.realpath(__file__))
    return LaunchDescription([
        Node(package='turtlesim', executable='turtlesim_node', name='turtlesim', parameters=[{'background_r': 200}]),
        ExecuteProcess(cmd=['python3', os.path.join(here, 'two_circles.py')], output='screen'),
    ])
