from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, OpaqueFunction, LogInfo
from launch.conditions import LaunchConfigurationEquals, UnlessCondition
from launch.substitutions import LaunchConfiguration, PythonExpression, TextSubstitution
from launch_ros.actions import Node, PushRosNamespace, SetParameter


def cameras(context, *args, **kwargs):
    names = LaunchConfiguration('names').perform(context).split(',')
    return [
        GroupAction([
            PushRosNamespace(name),
            SetParameter('width', 8, condition=LaunchConfigurationEquals('wide', name)),
            Node(package='namespace_demo', executable='camera_demo_exe', output='screen', emulate_tty=True,
                 parameters=[{'fps': PythonExpression(['20 if "', name, '" == "', LaunchConfiguration('fast'), '" else 10'])}]),
        ])
        for name in names
    ]


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('names', default_value=TextSubstitution(text='front,left,right')),
        DeclareLaunchArgument('fast', default_value='front'),
        DeclareLaunchArgument('wide', default_value='left'),
        DeclareLaunchArgument('quiet', default_value='false'),
        OpaqueFunction(function=cameras),
        LogInfo(msg=['cameras: ', LaunchConfiguration('names')], condition=UnlessCondition(LaunchConfiguration('quiet'))),
        Node(package='namespace_demo', executable='rate_check', output='screen'),
    ])
