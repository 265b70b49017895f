"""Two robots, one program, started twice."""

from launch import LaunchDescription


def generate_launch_description():
    return LaunchDescription([
        # TODO: three nodes: the world, and two drivers
    ])
