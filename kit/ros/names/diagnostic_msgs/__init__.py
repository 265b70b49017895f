"""ROS 2's diagnostic_msgs: see ``kit.msg.diagnostic_msgs``."""
