from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, EmitEvent, GroupAction, RegisterEventHandler
from launch.conditions import IfCondition
from launch.event_handlers import OnProcessExit
from launch.events import Shutdown
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import LifecycleNode, Node, PushRosNamespace
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    params = PathJoinSubstitution([FindPackageShare("course_bringup"), "config", "params.yaml"])
    tour = Node(
        package="course_py",
        executable="tour",
        output="screen",
        parameters=[params, {"title": LaunchConfiguration("title")}],
        remappings=[("battery", "reading")],
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument("title", default_value="album"),
            DeclareLaunchArgument("with_cpp", default_value="true"),
            GroupAction(
                [
                    PushRosNamespace("class"),
                    Node(package="course_py", executable="reading_publisher", parameters=[params]),
                    Node(package="course_py", executable="area_server"),
                    Node(package="course_py", executable="count_server"),
                    LifecycleNode(
                        package="course_py", executable="camera", name="camera", namespace="", autostart=True
                    ),
                    Node(
                        package="course_cpp",
                        executable="listener",
                        condition=IfCondition(LaunchConfiguration("with_cpp")),
                    ),
                    tour,
                ]
            ),
            RegisterEventHandler(
                OnProcessExit(
                    target_action=tour, on_exit=[EmitEvent(event=Shutdown(reason="the tour is over"))]
                )
            ),
        ]
    )
