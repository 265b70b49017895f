"""ROS 2's rosgraph_msgs: see ``kit.msg.rosgraph_msgs``."""
