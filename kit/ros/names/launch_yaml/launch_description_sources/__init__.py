from kit.ros.launch.sources import LaunchDescriptionSource as YAMLLaunchDescriptionSource

__all__ = ["YAMLLaunchDescriptionSource"]
