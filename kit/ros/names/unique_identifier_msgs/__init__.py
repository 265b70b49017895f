"""ROS 2's unique_identifier_msgs: see ``kit.msg.unique_identifier_msgs``."""
