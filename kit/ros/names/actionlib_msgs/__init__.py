"""ROS 2's actionlib_msgs: see ``kit.msg.actionlib_msgs``."""
