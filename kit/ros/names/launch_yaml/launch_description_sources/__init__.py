from kit.ros.launch.actions import LaunchDescriptionSource as YAMLLaunchDescriptionSource

__all__ = ["YAMLLaunchDescriptionSource"]
