import launch
import launch_ros.actions


def generate_launch_description():
    ld = launch.LaunchDescription()
    for name in ('recorder', 'mover'):
        ld.add_action(launch_ros.actions.Node(package='odom_recorder', executable=name, respawn=True, respawn_delay=2.0))
    ld.add_action(launch_ros.actions.Node(package='odom_recorder', executable='task', output='screen',
                                          on_exit=launch.actions.Shutdown()))
    return ld
