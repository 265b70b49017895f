"""launch.substitution of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.launch.substitutions import Substitution

__all__ = ["Substitution"]
