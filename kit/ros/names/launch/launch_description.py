from kit.ros.launch.entity import LaunchDescription

__all__ = ["LaunchDescription"]
