"""Two robots, one program, started twice. Somebody was in a hurry."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def driver(side):
    return Node(
        package="convoy",
        executable="cruise",
        name="driver",
        namespace=side,
        parameters=[{"velocity": LaunchConfiguration(side + "_speed")}],
        remappings=[("command", "/cmd_vel")],
    )


def generate_launch_description():
    share = FindPackageShare("convoy")
    return LaunchDescription([
        DeclareLaunchArgument("world", default_value="one.yaml"),
        DeclareLaunchArgument("left_speed", default_value="0.3"),
        DeclareLaunchArgument("right_speed", default_value="0.2"),
        Node(
            package="flatland_server",
            executable="flatland_server",
            name="flatland_server",
            parameters=[{
                "world_path": PathJoinSubstitution([share, "worlds", LaunchConfiguration("world")]),
                "update_rate": 100.0,
                "step_size": 0.01,
            }],
        ),
        driver("left"),
        driver("left"),
    ])
