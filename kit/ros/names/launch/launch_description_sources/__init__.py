from kit.ros.launch.actions import LaunchDescriptionSource

# Each of them reads a file by the end of its name.
AnyLaunchDescriptionSource = FrontendLaunchDescriptionSource = LaunchDescriptionSource
PythonLaunchDescriptionSource = LaunchDescriptionSource

__all__ = [
    "AnyLaunchDescriptionSource",
    "FrontendLaunchDescriptionSource",
    "PythonLaunchDescriptionSource",
]
