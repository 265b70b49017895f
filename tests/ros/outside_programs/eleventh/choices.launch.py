from launch import LaunchDescription
from launch.actions import (DeclareLaunchArgument, EmitEvent, ExecuteProcess, GroupAction, LogInfo, OpaqueFunction,
                            RegisterEventHandler, SetEnvironmentVariable, SetLaunchConfiguration, TimerAction)
from launch.conditions import IfCondition, LaunchConfigurationEquals, LaunchConfigurationNotEquals, UnlessCondition
from launch.event_handlers import OnProcessExit
from launch.events import Shutdown
from launch.substitutions import (AndSubstitution, EnvironmentVariable, EqualsSubstitution, FileContent,
                                  IfElseSubstitution, LaunchConfiguration, NotEqualsSubstitution, NotSubstitution,
                                  OrSubstitution, PathJoinSubstitution, PythonExpression, ThisLaunchFileDir)


def workers(context, *args, **kwargs):
    count = int(LaunchConfiguration('count').perform(context))
    robot = context.launch_configurations['robot']
    code = 'import os, sys; print("worker", sys.argv[1], "of", sys.argv[2], "level", os.environ["LEVEL"])'
    processes = [
        ExecuteProcess(cmd=['python3', '-c', code, str(index), robot], name=f'worker{index}', output='screen')
        for index in range(count)]
    chain = [RegisterEventHandler(OnProcessExit(target_action=a, on_exit=[b]))
             for a, b in zip(processes, processes[1:])]
    end = RegisterEventHandler(OnProcessExit(
        target_action=processes[-1],
        on_exit=lambda event, context: [
            LogInfo(msg=f'workers done, code {event.returncode}'), EmitEvent(event=Shutdown(reason='done'))]))
    return [*chain, end, processes[0]]


def generate_launch_description():
    robot, count = LaunchConfiguration('robot'), LaunchConfiguration('count')
    is_waffle = EqualsSubstitution(robot, 'waffle')
    many = PythonExpression([count, ' > 2'])
    both = AndSubstitution(is_waffle, many)
    return LaunchDescription([
        DeclareLaunchArgument('robot', default_value='burger', choices=['burger', 'waffle']),
        DeclareLaunchArgument('count', default_value='1'),
        SetLaunchConfiguration('place', 'outer again'),
        GroupAction([
            SetLaunchConfiguration('place', 'scoped inner'),
            LogInfo(msg=LaunchConfiguration('place')),
        ], scoped=True),
        LogInfo(msg=LaunchConfiguration('place')),
        LogInfo(msg=['robot is a ', robot, ' with ', count, ' wheels'], condition=IfCondition(is_waffle)),
        LogInfo(msg='robot is a burger', condition=LaunchConfigurationEquals('robot', 'burger')),
        LogInfo(msg='never', condition=UnlessCondition(OrSubstitution(is_waffle, 'false'))),
        LogInfo(msg=['many: ', both], condition=IfCondition(NotSubstitution(NotEqualsSubstitution(count, '3')))),
        LogInfo(msg=['speed ', IfElseSubstitution(both, if_value='fast', else_value='slow')]),
        OpaqueFunction(function=lambda context: [LogInfo(msg='file exists: ' + str('Enum' in FileContent(
            PathJoinSubstitution([ThisLaunchFileDir(), 'waypoint_node.py'])).perform(context)))]),
        SetEnvironmentVariable('LEVEL', PythonExpression(['2 * ', count, ' + 1'])),
        TimerAction(period=1.0, actions=[
            OpaqueFunction(function=workers, condition=LaunchConfigurationNotEquals('robot', 'burger'))]),
        TimerAction(period=0.5, actions=[LogInfo(msg=['level ', EnvironmentVariable('LEVEL')])]),
    ])
