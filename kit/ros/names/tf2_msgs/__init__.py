"""ROS 2's tf2_msgs: see ``kit.msg.tf2_msgs``."""
