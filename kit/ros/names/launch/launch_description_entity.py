from kit.ros.launch.entity import LaunchDescriptionEntity

__all__ = [
    "LaunchDescriptionEntity",
]
