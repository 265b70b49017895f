from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, GroupAction, LogInfo, OpaqueFunction, RegisterEventHandler, TimerAction
from launch.conditions import IfCondition, UnlessCondition
from launch.event_handlers import OnExecutionComplete, OnProcessExit, OnProcessIO
from launch.substitutions import FindExecutable, LaunchConfiguration, PythonExpression
from launch_ros.actions import Node, PushRosNamespace, SetRemap


def say(context, *args, **kwargs):
    red = LaunchConfiguration("red").perform(context)
    return [LogInfo(msg=f"red is {int(red)}")]


def generate_launch_description():
    red = LaunchConfiguration("red")
    spawn = ExecuteProcess(
        cmd=[[FindExecutable(name="ros2"), " service call ", "/spawn ", "turtlesim/srv/Spawn ",
              '"{x: 2, y: 2, theta: 0.2, name: \'lena\'}"']],
        shell=True, output="screen",
    )
    change = ExecuteProcess(
        cmd=[[FindExecutable(name="ros2"), " param set ", "/turtlesim background_r ", red]], shell=True, output="screen",
    )
    if_240 = ExecuteProcess(
        condition=IfCondition(PythonExpression([red, " == 240"])),
        cmd=[[FindExecutable(name="ros2"), " param get /turtlesim background_r"]], shell=True, output="screen",
    )
    swim = ExecuteProcess(
        cmd=["ros2", "topic", "pub", "--times", "3", "--rate", "1", "/lena/cmd_vel", "geometry_msgs/msg/Twist",
             "{linear: {x: 1.0}, angular: {z: 0.0}}"],
        output="screen",
    )
    return LaunchDescription([
        DeclareLaunchArgument("red", default_value="240", choices=["120", "240"]),
        OpaqueFunction(function=say),
        spawn,
        RegisterEventHandler(OnProcessIO(target_action=spawn, on_stdout=lambda event: LogInfo(
            msg="Spawn says: " + event.text.decode().strip()[:10]))),
        RegisterEventHandler(OnExecutionComplete(target_action=spawn, on_completion=[change])),
        RegisterEventHandler(OnProcessExit(target_action=change, on_exit=[
            TimerAction(period=1.0, actions=[if_240, swim])])),
        GroupAction([
            PushRosNamespace("quiet"),
            SetRemap("pose", "/lena/pose"),
            Node(package="turtlesim", executable="mimic", name="copy", condition=UnlessCondition("true"),
                 remappings=[("/input/pose", "/turtle1/pose"), ("/output/cmd_vel", "/lena/cmd_vel")]),
        ]),
    ])
