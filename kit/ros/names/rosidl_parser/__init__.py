"""rosidl_parser of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names
