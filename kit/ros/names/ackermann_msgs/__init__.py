"""ROS 2's ackermann_msgs: see ``kit.msg.ackermann_msgs``."""
