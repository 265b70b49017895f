"""Two robots, one program, started twice."""

# Lesson: `world` (`two.yaml`, the name of a file in the package's folder `world`)

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
        parameters=[{"speed": LaunchConfiguration(side + "_speed")}],
        remappings=[("command", "cmd_vel")],
    )


def generate_launch_description():
    share = FindPackageShare("convoy")
    return LaunchDescription([
        DeclareLaunchArgument("left_speed", default_value="0.3"),
        DeclareLaunchArgument("right_speed", default_value="0.2"),
        Node(
            package="flatland_server",
            executable="flatland_server",
            name="flatland_server",
            parameters=[{
                "world_path": PathJoinSubstitution([share, "world", "two.yaml"]),
                "update_rate": 100.0,
                "step_size": 0.01,
            }],
        ),
        driver("left"),
        driver("right"),
    ])
