"""Starts the kitchen; the oven is a managed node that is brought up by events, the cook follows, and the meal ends the launch."""
import os

import launch
import launch_ros.actions
import launch_ros.event_handlers
import launch_ros.events.lifecycle
import lifecycle_msgs.msg
from launch.actions import EmitEvent, RegisterEventHandler
from launch.events import matches_action

HERE = os.path.dirname(os.path.abspath(__file__))


def generate_launch_description():
    ld = launch.LaunchDescription()
    parameters = launch_ros.parameter_descriptions.ParameterFile(
        os.path.join(HERE, 'kitchen', 'config', 'oven.yaml'), allow_substs=True)
    oven = launch_ros.actions.LifecycleNode(
        package='kitchen', executable='oven', name='oven', namespace='kitchen', output='screen',
        parameters=[parameters, {'start': 20.0}])
    cook = launch_ros.actions.Node(
        package='kitchen', executable='cook', namespace='kitchen', output='screen', exec_name='chef',
        remappings=[('heat', 'oven/heat')], arguments=['--dish', launch.substitutions.LaunchConfiguration('dish')])

    def change(transition):
        return EmitEvent(event=launch_ros.events.lifecycle.ChangeState(
            lifecycle_node_matcher=matches_action(oven), transition_id=transition))

    ld.add_action(launch.actions.DeclareLaunchArgument('dish', default_value='soup'))
    ld.add_action(launch.actions.SetLaunchConfiguration('rate', '10.0'))
    ld.add_action(oven)
    ld.add_action(RegisterEventHandler(launch_ros.event_handlers.OnStateTransition(
        target_lifecycle_node=oven, start_state='configuring', goal_state='inactive',
        entities=[launch.actions.LogInfo(msg='oven is inactive, heating'),
                  change(lifecycle_msgs.msg.Transition.TRANSITION_ACTIVATE)])))
    ld.add_action(RegisterEventHandler(launch_ros.event_handlers.OnStateTransition(
        target_lifecycle_node=oven, goal_state='active', entities=[cook])))
    ld.add_action(RegisterEventHandler(launch.event_handlers.OnProcessExit(
        target_action=cook,
        on_exit=[change(lifecycle_msgs.msg.Transition.TRANSITION_DEACTIVATE),
                 launch.actions.TimerAction(period=1.0, actions=[launch.actions.Shutdown(reason='the meal is ready')])])))
    ld.add_action(launch.actions.TimerAction(
        period=1.0, actions=[change(lifecycle_msgs.msg.Transition.TRANSITION_CONFIGURE)]))
    return ld
