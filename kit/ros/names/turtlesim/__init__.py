"""ROS 2's turtlesim: see ``kit.msg.turtlesim``."""
