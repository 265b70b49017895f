"""ROS 2's std_msgs: see ``kit.msg.std_msgs``."""
