"""ROS 2's launch_yaml, as this project offers it."""
