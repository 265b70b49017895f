import os
import shutil
from launch import LaunchDescription
from launch.actions import ExecuteProcess, RegisterEventHandler, TimerAction, Shutdown
from launch.event_handlers import OnProcessExit

BAG = '/tmp/real/p16_turtle_bag'


def generate_launch_description():
    shutil.rmtree(BAG, ignore_errors=True)
    here = os.path.dirname(__file__)
    program = ExecuteProcess(cmd=['python3', os.path.join(here, 'bag_rw.py')], output='screen')
    record = ExecuteProcess(cmd=['ros2', 'bag', 'record', '-o', BAG, '/joints', '-s', 'mcap'], output='screen')
    info = ExecuteProcess(cmd=['ros2', 'bag', 'info', BAG], output='screen', on_exit=[Shutdown(reason='all told')])
    return LaunchDescription([
        record,
        TimerAction(period=1.0, actions=[program]),
        RegisterEventHandler(OnProcessExit(target_action=program, on_exit=[
            ExecuteProcess(cmd=['pkill', '-INT', '-f', 'bag record.*p16_turtle_bag'])] if False else [
            TimerAction(period=0.5, actions=[__import__('launch').actions.EmitEvent(
                event=__import__('launch').events.process.SignalProcess(
                    signal_number='SIGINT', process_matcher=__import__('launch').events.matches_action(record)))])])),
        RegisterEventHandler(OnProcessExit(target_action=record, on_exit=[info])),
    ])
