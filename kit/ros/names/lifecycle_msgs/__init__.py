"""ROS 2's lifecycle_msgs: see ``kit.msg.lifecycle_msgs``."""
