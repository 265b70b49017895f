"""launch_yaml.launch_description_sources of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.launch.description_sources import LaunchDescriptionSource as YAMLLaunchDescriptionSource

__all__ = ["YAMLLaunchDescriptionSource"]
