from pathlib import Path
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, TimerAction
from launch.substitutions import LaunchConfiguration, FindExecutable
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('speed', default_value='2.0'),
        DeclareLaunchArgument('boundary_margin', default_value='0.5'),
        Node(package='turtlesim', executable='turtlesim_node'),
        ExecuteProcess(cmd=[FindExecutable(name='python3'), str(Path(__file__).parent / 'draw_boundaries.py'),
                            '--ros-args', '-p', ['speed:=', LaunchConfiguration('speed')],
                            '-p', ['boundary_margin:=', LaunchConfiguration('boundary_margin')]], output='screen'),
        TimerAction(period=4.0, actions=[ExecuteProcess(
            cmd=['ros2', 'service', 'call', '/draw_boundaries/manual', 'std_srvs/srv/SetBool', '"{data: true}"'],
            shell=True, output='screen')]),
        TimerAction(period=8.0, actions=[ExecuteProcess(
            cmd=['ros2 service call /draw_boundaries/manual std_srvs/srv/SetBool "{data: false}"'],
            shell=True, output='screen')]),
    ])
