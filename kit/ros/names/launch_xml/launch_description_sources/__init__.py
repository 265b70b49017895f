from kit.ros.launch.actions import LaunchDescriptionSource as XMLLaunchDescriptionSource

__all__ = ["XMLLaunchDescriptionSource"]
