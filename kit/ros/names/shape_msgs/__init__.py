"""ROS 2's shape_msgs: see ``kit.msg.shape_msgs``."""
