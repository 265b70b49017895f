"""Two belts in namespaces by one included file, a third only on wish, one scale for all."""
from launch import LaunchDescription
from launch.actions import (DeclareLaunchArgument, ExecuteProcess, GroupAction,
                            IncludeLaunchDescription, LogInfo, RegisterEventHandler,
                            SetLaunchConfiguration, Shutdown)
from launch.conditions import IfCondition, LaunchConfigurationEquals, UnlessCondition
from launch.event_handlers import OnProcessExit, OnProcessStart
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import (AndSubstitution, IfElseSubstitution, LaunchConfiguration,
                                  NotSubstitution, PathJoinSubstitution, PythonExpression)
from launch_ros.actions import Node, PushRosNamespace, SetParameter, SetRemap
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    one_belt = PathJoinSubstitution([FindPackageShare('conveyor'), 'launch', 'belt.launch.py'])
    night = LaunchConfiguration('night')
    third = LaunchConfiguration('third')

    def belt(name, weights, label, **more):
        return GroupAction([
            PushRosNamespace(name),
            SetRemap(src='items', dst='/all'),
            SetParameter('site', 'lisbon'),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(one_belt),
                launch_arguments={'weights': weights, 'label': label}.items()),
        ], **more)

    scale = Node(package='conveyor', executable='scale', name='balance', output='screen',
                 arguments=[IfElseSubstitution(third, if_value='6', else_value='5')])
    return LaunchDescription([
        DeclareLaunchArgument('night', default_value='false'),
        DeclareLaunchArgument('third', default_value=NotSubstitution(night)),
        SetLaunchConfiguration('label', 'outer'),
        scale,
        belt('north', '1+2+3', 'red'),
        belt('south', '10+20', IfElseSubstitution(night, 'plain', 'blue')),
        belt('extra', '100', 'plain', condition=IfCondition(AndSubstitution(third, NotSubstitution(night)))),
        LogInfo(msg='night shift', condition=IfCondition(night)),
        LogInfo(msg=['label is still ', LaunchConfiguration('label')],
                condition=LaunchConfigurationEquals('label', 'outer')),
        LogInfo(msg=PythonExpression(["'belts: ' + str(3 if '", third, "' == 'true' else 2)"]),
                condition=UnlessCondition(night)),
        RegisterEventHandler(OnProcessStart(
            target_action=scale, on_start=lambda event, context: LogInfo(msg='scale runs'))),
        RegisterEventHandler(OnProcessExit(
            target_action=scale,
            on_exit=[ExecuteProcess(cmd=['echo', 'all', 'weighed'], output='screen',
                                    on_exit=Shutdown(reason='weighed'))])),
    ])
