"""A process that is respawned until it stands, seen by its output, then called, then shut down."""
import os
import sys
import tempfile

from launch import LaunchDescription
from launch.actions import (EmitEvent, ExecuteProcess, LogInfo, RegisterEventHandler,
                            SetEnvironmentVariable, TimerAction, UnregisterEventHandler)
from launch.event_handlers import OnProcessExit, OnProcessIO, OnShutdown
from launch.events import Shutdown
from launch.substitutions import LocalSubstitution, ThisLaunchFileDir

HERE = os.path.dirname(os.path.realpath(__file__))


def generate_launch_description():
    counter = os.path.join(tempfile.mkdtemp(), 'count')
    flaky = ExecuteProcess(cmd=[sys.executable, os.path.join(HERE, 'flaky.py')], name='flaky',
                           respawn=True, respawn_delay=1.0, output='both', emulate_tty=True)
    call = ExecuteProcess(
        cmd=['ros2', 'service', 'call', '/are_you_up', 'std_srvs/srv/Trigger', '{}'],
        output='screen', shell=False)

    def on_line(event):
        if 'READY' in event.text.decode():
            return [LogInfo(msg='ready seen'), call]

    died = RegisterEventHandler(OnProcessExit(
        target_action=flaky,
        on_exit=lambda event, context: LogInfo(msg=f'died with {event.returncode}')))
    return LaunchDescription([
        SetEnvironmentVariable('FLAKY_COUNTER', counter),
        LogInfo(msg=['beside: ', ThisLaunchFileDir()]),
        flaky,
        died,
        RegisterEventHandler(OnProcessIO(target_action=flaky, on_stdout=on_line)),
        RegisterEventHandler(OnProcessExit(target_action=call, on_exit=[
            UnregisterEventHandler(died.event_handler),
            TimerAction(period=1.0, actions=[EmitEvent(event=Shutdown(reason='answered'))])])),
        RegisterEventHandler(OnShutdown(
            on_shutdown=[LogInfo(msg=['because ', LocalSubstitution('event.reason')])])),
    ])
