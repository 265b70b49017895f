# ROS 2 tutorial "Creating a launch file", extended: groups and namespaces
from launch import LaunchDescription
from launch.actions import (DeclareLaunchArgument, ExecuteProcess, GroupAction, LogInfo, OpaqueFunction,
                            RegisterEventHandler, SetEnvironmentVariable, TimerAction)
from launch.conditions import IfCondition, UnlessCondition
from launch.event_handlers import OnProcessStart
from launch.substitutions import (EnvironmentVariable, LaunchConfiguration, NotSubstitution, PythonExpression,
                                  TextSubstitution)
from launch_ros.actions import Node, PushRosNamespace, SetParameter, SetRemap


def say(context, *args, **kwargs):
    who = LaunchConfiguration('who').perform(context)
    return [LogInfo(msg=f'opaque function says {who}')]


def generate_launch_description():
    sim = Node(package='turtlesim', executable='turtlesim_node', name='sim')
    return LaunchDescription([
        DeclareLaunchArgument('who', default_value=TextSubstitution(text='ann'), description='whom to greet'),
        DeclareLaunchArgument('mimic', default_value='true', choices=['true', 'false']),
        SetEnvironmentVariable('LAB', [LaunchConfiguration('who'), '_lab']),
        OpaqueFunction(function=say),
        LogInfo(msg=['lab is ', EnvironmentVariable('LAB')]),
        GroupAction([PushRosNamespace('one'), SetParameter('background_r', 200), sim]),
        GroupAction([PushRosNamespace('two'),
                     Node(package='turtlesim', executable='turtlesim_node', name='sim')]),
        GroupAction(
            condition=IfCondition(LaunchConfiguration('mimic')),
            actions=[
                SetRemap('/input/pose', '/one/turtle1/pose'),
                SetRemap('/output/cmd_vel', '/two/turtle1/cmd_vel'),
                Node(package='turtlesim', executable='mimic', name='mimic'),
            ]),
        LogInfo(msg='no mimic', condition=UnlessCondition(LaunchConfiguration('mimic'))),
        LogInfo(msg='mimics', condition=UnlessCondition(NotSubstitution(LaunchConfiguration('mimic')))),
        LogInfo(msg=['twice: ', PythonExpression(["2 * len('", LaunchConfiguration('who'), "')"])]),
        RegisterEventHandler(OnProcessStart(
            target_action=sim,
            on_start=[TimerAction(period=2.0, actions=[
                ExecuteProcess(cmd=['ros2', 'param', 'get', '/one/sim', 'background_r'], output='screen'),
                ExecuteProcess(cmd=['ros2', 'topic', 'pub', '--times', '5', '-r', '2', '/one/turtle1/cmd_vel',
                                    'geometry_msgs/msg/Twist', '{linear: {x: 1.0}, angular: {z: 0.5}}']),
            ])])),
    ])
