import launch
import launch_ros
import lifecycle_msgs.msg
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, EmitEvent, LogInfo, RegisterEventHandler, TimerAction
from launch.event_handlers import OnProcessStart
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import LifecycleNode
from launch_ros.event_handlers import OnStateTransition
from launch_ros.events.lifecycle import ChangeState
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description():
    pump = LifecycleNode(
        package="bringup",
        executable="pump",
        name="pump",
        namespace="cellar",
        parameters=[{"litres": ParameterValue(LaunchConfiguration("litres"), value_type=float)}],
        output="screen",
    )

    def change(transition):
        return EmitEvent(
            event=ChangeState(
                lifecycle_node_matcher=launch.events.matches_action(pump),
                transition_id=transition,
            )
        )

    return LaunchDescription(
        [
            DeclareLaunchArgument("litres", default_value="0.5"),
            RegisterEventHandler(
                OnProcessStart(
                    target_action=pump,
                    on_start=[change(lifecycle_msgs.msg.Transition.TRANSITION_CONFIGURE)],
                )
            ),
            RegisterEventHandler(
                OnStateTransition(
                    target_lifecycle_node=pump,
                    start_state="configuring",
                    goal_state="inactive",
                    entities=[
                        LogInfo(msg="the pump is configured, now it is activated"),
                        change(lifecycle_msgs.msg.Transition.TRANSITION_ACTIVATE),
                    ],
                )
            ),
            RegisterEventHandler(
                launch_ros.event_handlers.OnStateTransition(
                    target_lifecycle_node=pump,
                    goal_state="active",
                    entities=[
                        TimerAction(
                            period=2.1, actions=[change(lifecycle_msgs.msg.Transition.TRANSITION_DEACTIVATE)]
                        ),
                    ],
                )
            ),
            RegisterEventHandler(
                OnStateTransition(
                    target_lifecycle_node=pump,
                    start_state="deactivating",
                    goal_state="inactive",
                    entities=[change(lifecycle_msgs.msg.Transition.TRANSITION_CLEANUP)],
                )
            ),
            pump,
        ]
    )
