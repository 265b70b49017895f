from launch import LaunchDescription
from launch.actions import ExecuteProcess, TimerAction
from launch.substitutions import FindExecutable, PathJoinSubstitution, ThisLaunchFileDir


def ros2(seconds, *words):
    return TimerAction(period=float(seconds), actions=[
        ExecuteProcess(cmd=[[FindExecutable(name='ros2'), ' ', ' '.join(words)]], shell=True, output='screen')])


def generate_launch_description():
    node = ExecuteProcess(
        cmd=['python3', PathJoinSubstitution([ThisLaunchFileDir(), 'pid_heading.py']), '--ros-args',
             '-p', 'kp:=1.0', '--log-level', 'warn'], output='screen')
    return LaunchDescription([
        node,
        ros2(3, 'topic', 'pub', '--once', '-w', '1', '/heading', 'std_msgs/msg/Float64', '"{data: 1.0}"'),
        ros2(5, 'param', 'set', '/pid_heading', 'kp', '3.0'),
        ros2(7, 'topic', 'pub', '--once', '-w', '1', '/heading', 'std_msgs/msg/Float64', '"{data: -2.0}"'),
        ros2(9, 'param', 'set', '/pid_heading', 'kp', '-- -1.0'),
        ros2(11, 'param', 'get', '/pid_heading', 'kp'),
    ])
