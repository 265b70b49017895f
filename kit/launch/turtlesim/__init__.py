"""ROS 2's turtlesim: its turtles, what they draw, and its node. The programs beside it are in ``share/turtlesim``."""
