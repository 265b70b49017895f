from launch import LaunchDescription
from launch.actions import EmitEvent, LogInfo, RegisterEventHandler, TimerAction
from launch.events import Shutdown, matches_action
from launch_ros.actions import LifecycleNode, Node
from launch_ros.event_handlers import OnStateTransition
from launch_ros.events.lifecycle import ChangeState
from lifecycle_msgs.msg import Transition


def generate_launch_description():
    thermometer = LifecycleNode(
        package='heater', executable='thermometer', name='thermometer', namespace='',
        parameters=[{'start': 18.0}], output='screen')

    def change(transition):
        return EmitEvent(event=ChangeState(
            lifecycle_node_matcher=matches_action(thermometer), transition_id=transition))

    return LaunchDescription([
        Node(package='heater', executable='listener', output='screen'),
        thermometer,
        RegisterEventHandler(OnStateTransition(
            target_lifecycle_node=thermometer, goal_state='inactive', start_state='configuring',
            entities=[LogInfo(msg='launch: configured'),
                      change(Transition.TRANSITION_ACTIVATE)])),
        RegisterEventHandler(OnStateTransition(
            target_lifecycle_node=thermometer, goal_state='active',
            entities=[LogInfo(msg='launch: active')])),
        TimerAction(period=1.0, actions=[change(Transition.TRANSITION_CONFIGURE)]),
        TimerAction(period=2.0, actions=[change(Transition.TRANSITION_ACTIVATE)]),
        TimerAction(period=4.1, actions=[change(Transition.TRANSITION_DEACTIVATE)]),
        TimerAction(period=6.5, actions=[change(Transition.TRANSITION_INACTIVE_SHUTDOWN)]),
        TimerAction(period=8.0, actions=[EmitEvent(event=Shutdown(reason='all shown'))]),
    ])
