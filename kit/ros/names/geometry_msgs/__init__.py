"""ROS 2's geometry_msgs: see ``kit.msg.geometry_msgs``."""
