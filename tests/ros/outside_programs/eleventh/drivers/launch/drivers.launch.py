from launch import LaunchDescription
from launch.actions import EmitEvent, LogInfo, RegisterEventHandler, Shutdown
from launch.event_handlers import OnProcessExit
from launch.events import matches_action
from launch.substitutions import PathJoinSubstitution
from launch_ros.actions import LifecycleNode, Node
from launch_ros.event_handlers import OnStateTransition
from launch_ros.events.lifecycle import ChangeState
from launch_ros.substitutions import FindPackageShare
from lifecycle_msgs.msg import Transition


def change(node, transition):
    return EmitEvent(event=ChangeState(lifecycle_node_matcher=matches_action(node), transition_id=transition))


def generate_launch_description():
    camera = LifecycleNode(
        package='drivers', executable='camera', name='camera', namespace='sensors', output='screen',
        parameters=[PathJoinSubstitution([FindPackageShare('drivers'), 'config', 'camera.yaml'])])
    viewer = Node(package='drivers', executable='viewer', namespace='sensors', output='screen')

    def when(start, goal, *actions):
        return RegisterEventHandler(OnStateTransition(
            target_lifecycle_node=camera, start_state=start, goal_state=goal, entities=list(actions)))

    return LaunchDescription([
        when('configuring', 'inactive', change(camera, Transition.TRANSITION_ACTIVATE)),
        when('activating', 'active', LogInfo(msg='camera is active, viewer starts'), viewer),
        when('deactivating', 'inactive', change(camera, Transition.TRANSITION_CLEANUP)),
        when('cleaningup', 'unconfigured', change(camera, Transition.TRANSITION_UNCONFIGURED_SHUTDOWN)),
        when('shuttingdown', 'finalized', LogInfo(msg='camera is finalized'), Shutdown(reason='all done')),
        RegisterEventHandler(OnProcessExit(
            target_action=viewer, on_exit=[change(camera, Transition.TRANSITION_DEACTIVATE)])),
        camera,
        change(camera, Transition.TRANSITION_CONFIGURE),
    ])
