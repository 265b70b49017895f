from kit.ros.launch.context import LaunchContext

__all__ = ["LaunchContext"]
