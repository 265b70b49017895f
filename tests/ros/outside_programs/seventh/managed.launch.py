import os
from launch import LaunchDescription
from launch.actions import ExecuteProcess, LogInfo, RegisterEventHandler, EmitEvent
from launch.event_handlers import OnProcessExit
from launch.events import Shutdown
from launch.events.process import ProcessExited  # noqa: F401


def generate_launch_description():
    here = os.path.dirname(__file__)
    managed = ExecuteProcess(cmd=['python3', 'managed_heartbeat.py'], cwd=here, output='screen', name='managed')
    boss = ExecuteProcess(cmd=['python3', 'supervisor.py'], cwd=here, output='both')
    return LaunchDescription([
        managed, boss,
        RegisterEventHandler(OnProcessExit(target_action=boss, on_exit=[LogInfo(msg='supervisor is done'), EmitEvent(event=Shutdown(reason='done'))])),
    ])
