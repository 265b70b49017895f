from launch import LaunchDescription
from launch.actions import (
    AppendEnvironmentVariable,
    DeclareLaunchArgument,
    EmitEvent,
    ExecuteProcess,
    GroupAction,
    LogInfo,
    OpaqueFunction,
    RegisterEventHandler,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
    TimerAction,
    UnsetEnvironmentVariable,
    UnsetLaunchConfiguration,
)
from launch.conditions import IfCondition, LaunchConfigurationEquals, LaunchConfigurationNotEquals, UnlessCondition
from launch.event_handlers import OnProcessExit, OnProcessIO, OnProcessStart, OnShutdown
from launch.events import Shutdown
from launch.substitutions import (
    AndSubstitution,
    AnySubstitution,
    Command,
    EnvironmentVariable,
    EqualsSubstitution,
    FindExecutable,
    LaunchConfiguration,
    LocalSubstitution,
    NotEqualsSubstitution,
    NotSubstitution,
    PathJoinSubstitution,
    PythonExpression,
    TextSubstitution,
    ThisLaunchFileDir,
)


def plants(context, *args, **kwargs):
    count = int(LaunchConfiguration('plants').perform(context))
    return [LogInfo(msg=f'plant {number} of {context.launch_configurations["kind"]}') for number in range(1, count + 1)]


def generate_launch_description():
    kind, night, heater = LaunchConfiguration('kind'), LaunchConfiguration('night'), LaunchConfiguration('heater')
    pump = ExecuteProcess(
        cmd=[FindExecutable(name='python3'), PathJoinSubstitution([ThisLaunchFileDir(), 'greenhouse_pump.py']),
             '--seconds', PythonExpression(['1.0 if ', night, ' else 2.0'])],
        additional_env={'PUMP': TextSubstitution(text='north')},
        name='pump',
        output='screen',
        sigterm_timeout='2',
    )
    fan = ExecuteProcess(
        cmd=['python3', PathJoinSubstitution([ThisLaunchFileDir(), 'greenhouse_pump.py']), '--seconds', '60'],
        name='fan', output='screen', condition=UnlessCondition(night))

    def on_pump_output(event):
        if 'water' in event.text.decode():
            return [LogInfo(msg=['io: ', event.text.decode().strip()])]

    return LaunchDescription([
        DeclareLaunchArgument('kind', default_value='tomato', choices=['tomato', 'basil'], description='what grows'),
        DeclareLaunchArgument('night', default_value='False'),
        DeclareLaunchArgument('plants', default_value=PythonExpression(["'2' if '", kind, "' == 'basil' else '3'"])),
        DeclareLaunchArgument('heater', default_value=night),
        SetEnvironmentVariable('HOUSE', 'glass'),
        AppendEnvironmentVariable('HOUSE', 'roof', separator='+'),
        LogInfo(msg=['house ', EnvironmentVariable('HOUSE'), ' ', EnvironmentVariable('NO_SUCH_HOUSE', default_value='none')]),
        LogInfo(msg='heating', condition=IfCondition(AndSubstitution(night, heater))),
        LogInfo(msg='any', condition=IfCondition(AnySubstitution(NotSubstitution(night), heater))),
        LogInfo(msg='basil!', condition=LaunchConfigurationEquals('kind', 'basil')),
        LogInfo(msg='no tomato', condition=LaunchConfigurationNotEquals('kind', 'tomato')),
        LogInfo(msg='not so', condition=IfCondition(NotEqualsSubstitution(kind, 'basil'))),
        LogInfo(msg=['equal ', EqualsSubstitution(kind, 'basil')]),
        GroupAction([
            SetLaunchConfiguration('kind', 'mint'),
            LogInfo(msg=['inside ', kind]),
            GroupAction([LogInfo(msg=['deep ', kind]), UnsetLaunchConfiguration('kind')], scoped=False),
        ], launch_configurations={'extra': '1'}),
        LogInfo(msg=['outside ', kind]),
        UnsetEnvironmentVariable('HOUSE'),
        LogInfo(msg=['unset ', EnvironmentVariable('HOUSE', default_value='gone')]),
        LogInfo(msg=['command ', Command(['echo ', kind])]),
        OpaqueFunction(function=plants),
        RegisterEventHandler(OnProcessStart(target_action=pump, on_start=[LogInfo(msg='pump started')])),
        RegisterEventHandler(OnProcessIO(target_action=pump, on_stdout=on_pump_output)),
        RegisterEventHandler(OnProcessExit(
            target_action=pump,
            on_exit=lambda event, context: [
                LogInfo(msg=f'pump left with {event.returncode}'),
                TimerAction(period=0.5, actions=[EmitEvent(event=Shutdown(reason='watered'))]),
            ])),
        RegisterEventHandler(OnShutdown(on_shutdown=[
            LogInfo(msg=['closing because ', LocalSubstitution('event.reason')])])),
        pump,
        fan,
    ])
