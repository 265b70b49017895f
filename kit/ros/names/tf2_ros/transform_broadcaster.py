"""tf2_ros.transform_broadcaster of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.tf import TransformBroadcaster

__all__ = ["TransformBroadcaster"]
