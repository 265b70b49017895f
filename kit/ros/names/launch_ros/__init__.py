"""ROS 2's part of launch, as this project offers it."""
