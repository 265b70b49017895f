"""ROS 2's statistics_msgs: see ``kit.msg.statistics_msgs``."""
