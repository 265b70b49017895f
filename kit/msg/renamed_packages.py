"""Packages whose interfaces are those of another one, by a name that ROS 2 has given them since."""

RENAMED_PACKAGES = {"turtlesim_msgs": "turtlesim"}
"""The older name, by the newer one."""
