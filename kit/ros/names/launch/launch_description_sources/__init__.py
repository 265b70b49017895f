from kit.ros.launch.sources import LaunchDescriptionSource

# All of them read Python files; a file of another kind gets an explanation.
AnyLaunchDescriptionSource = PythonLaunchDescriptionSource = LaunchDescriptionSource

__all__ = ["AnyLaunchDescriptionSource", "PythonLaunchDescriptionSource"]
