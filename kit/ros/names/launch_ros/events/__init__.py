"""Events of launch_ros."""
