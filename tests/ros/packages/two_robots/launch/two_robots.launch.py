import launch.conditions as conditions
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, SetEnvironmentVariable
from launch.substitutions import FindExecutable, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    pkg_share = FindPackageShare("two_robots")

    world_path = LaunchConfiguration("world_path")
    update_rate = LaunchConfiguration("update_rate")
    step_size = LaunchConfiguration("step_size")
    show_viz = LaunchConfiguration("show_viz")
    viz_pub_rate = LaunchConfiguration("viz_pub_rate")
    use_sim_time = LaunchConfiguration("use_sim_time")

    ld = LaunchDescription(
        [
            # Override on the command line, such as update_rate:="20.0"
            DeclareLaunchArgument(
                name="world_path",
                default_value=PathJoinSubstitution([pkg_share, "world/world.yaml"]),
            ),
            DeclareLaunchArgument(name="update_rate", default_value="100.0"),
            DeclareLaunchArgument(name="step_size", default_value="0.01"),
            DeclareLaunchArgument(name="show_viz", default_value="true"),
            DeclareLaunchArgument(name="viz_pub_rate", default_value="30.0"),
            DeclareLaunchArgument(name="use_sim_time", default_value="true"),
            DeclareLaunchArgument(name="speed", default_value="0.4", description="of both robots"),
            DeclareLaunchArgument(name="learn", default_value="false", choices=["true", "false"]),
            SetEnvironmentVariable(name="ROSCONSOLE_FORMAT", value="[${severity} ${time} ${logger}]: ${message}"),
            Node(
                name="flatland_server",
                package="flatland_server",
                executable="flatland_server",
                output="screen",
                parameters=[
                    {"world_path": world_path},
                    {"update_rate": update_rate},
                    {"step_size": step_size},
                    {"show_viz": show_viz},
                    {"viz_pub_rate": viz_pub_rate},
                    {"use_sim_time": use_sim_time},
                ],
            ),
            Node(
                name="pair",
                package="two_robots",
                executable="pair",
                output="screen",
                parameters=[{"speed": LaunchConfiguration("speed"), "greeting": "ready to drive"}],
                condition=conditions.UnlessCondition(LaunchConfiguration("learn")),
            ),
            Node(
                name="learner",
                namespace="left",
                package="two_robots",
                executable="learner",
                output="screen",
                condition=conditions.IfCondition(LaunchConfiguration("learn")),
            ),
            Node(
                name="tf",
                package="tf2_ros",
                executable="static_transform_publisher",
                arguments=["0", "0", "0", "0", "0", "0", "map", "odom"],
            ),
            Node(
                name="rviz",
                package="rviz2",
                executable="rviz2",
                arguments=["-d", PathJoinSubstitution([pkg_share, "rviz/robot_navigation.rviz"])],
                parameters=[{"use_sim_time": use_sim_time}],
                condition=conditions.IfCondition(show_viz),
            ),
            ExecuteProcess(
                cmd=[[FindExecutable(name="ros2"), " service call ", "/pause ", "std_srvs/srv/Empty"]],
                shell=True,
                condition=conditions.IfCondition("false"),
            ),
        ]
    )
    return ld
