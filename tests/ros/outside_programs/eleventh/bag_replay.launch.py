import os
import shutil
import tempfile
from pathlib import Path

from launch import LaunchDescription
from launch.actions import EmitEvent, ExecuteProcess, OpaqueFunction, RegisterEventHandler, TimerAction
from launch.event_handlers import OnProcessExit, OnShutdown
from launch.events import Shutdown, matches_action
from launch.events.process import SignalProcess

import signal

HERE = Path(__file__).resolve().parent


def generate_launch_description():
    folder = tempfile.mkdtemp()
    bag = os.path.join(folder, 'numbers')
    record = ExecuteProcess(cmd=['ros2', 'bag', 'record', '-o', bag, '/numbers'], output='screen')
    count = ExecuteProcess(cmd=['python3', str(HERE / 'bag_numbers.py'), 'count'], output='screen')
    info = ExecuteProcess(cmd=['ros2', 'bag', 'info', bag], output='screen')
    adder = ExecuteProcess(cmd=['python3', str(HERE / 'bag_numbers.py'), 'sum'], output='screen')
    play = ExecuteProcess(
        cmd=['ros2', 'bag', 'play', bag, '--rate', '2.0', '--delay', '1.0', '--remap', '/numbers:=/replayed'],
        output='screen')
    stop = EmitEvent(event=SignalProcess(signal_number=signal.SIGINT, process_matcher=matches_action(record)))

    def after(action, *entities):
        return RegisterEventHandler(OnProcessExit(target_action=action, on_exit=list(entities)))

    return LaunchDescription([
        record,
        TimerAction(period=3.0, actions=[count]),
        after(count, stop),
        after(record, info),
        after(info, adder, play),
        after(adder, EmitEvent(event=Shutdown(reason='summed'))),
        RegisterEventHandler(OnShutdown(on_shutdown=[
            OpaqueFunction(function=lambda context: shutil.rmtree(folder, ignore_errors=True))])),
    ])
