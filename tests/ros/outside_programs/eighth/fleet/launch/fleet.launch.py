import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import (DeclareLaunchArgument, EmitEvent, GroupAction, IncludeLaunchDescription, LogInfo,
                            OpaqueFunction, RegisterEventHandler, TimerAction)
from launch.conditions import IfCondition, UnlessCondition
from launch.event_handlers import OnProcessExit, OnShutdown
from launch.events import Shutdown
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import (EqualsSubstitution, LaunchConfiguration, LocalSubstitution, NotSubstitution,
                                  PythonExpression)
from launch_ros.actions import Node, PushRosNamespace, SetParameter, SetRemap


def told(context, *args, **kwargs):
    wanted = int(LaunchConfiguration('wanted').perform(context))
    return [LogInfo(msg=f'twice as many would be {2 * wanted}')]


def generate_launch_description():
    share = get_package_share_directory('fleet')
    carrier = PythonLaunchDescriptionSource(os.path.join(share, 'launch', 'carrier.launch.py'))
    params = os.path.join(share, 'config', 'fleet.yaml')
    wanted = LaunchConfiguration('wanted')
    dispatcher = Node(
        package='fleet', executable='dispatcher', name='dispatcher', namespace='office', output='screen',
        parameters=[params], arguments=[wanted],
    )
    east = GroupAction([
        PushRosNamespace('east'),
        SetRemap('carried', 'goods'),
        IncludeLaunchDescription(carrier),
    ])
    west = GroupAction(
        [
            PushRosNamespace('west'),
            SetRemap(src='carried', dst='goods'),
            SetParameter('load', 7),
            IncludeLaunchDescription(carrier, launch_arguments={'speed': 'fast'}.items()),
        ],
        condition=UnlessCondition(LaunchConfiguration('alone')),
    )
    return LaunchDescription([
        DeclareLaunchArgument('wanted', default_value='10', description='how much is wanted'),
        DeclareLaunchArgument('alone', default_value='false'),
        OpaqueFunction(function=told),
        dispatcher,
        TimerAction(period=1.0, actions=[east]),
        west,
        LogInfo(msg='much is wanted', condition=IfCondition(PythonExpression([wanted, ' > 50']))),
        LogInfo(msg='all of it', condition=IfCondition(EqualsSubstitution(wanted, '100'))),
        LogInfo(msg='with a partner', condition=IfCondition(NotSubstitution(LaunchConfiguration('alone')))),
        RegisterEventHandler(OnProcessExit(
            target_action=dispatcher,
            on_exit=lambda event, context: [
                LogInfo(msg=f'the dispatcher left with {event.returncode}'),
                EmitEvent(event=Shutdown(reason='all is here')),
            ],
        )),
        RegisterEventHandler(OnShutdown(on_shutdown=[
            LogInfo(msg=['shut down: ', LocalSubstitution('event.reason')]),
        ])),
    ])
