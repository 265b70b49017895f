from kit.ros.launch.sources import LaunchDescriptionSource as XMLLaunchDescriptionSource

__all__ = ["XMLLaunchDescriptionSource"]
