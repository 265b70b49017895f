"""ROS 2's flatland_msgs: see ``kit.msg.flatland_msgs``."""
