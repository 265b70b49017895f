"""ROS 2's service_msgs: see ``kit.msg.service_msgs``."""
