"""ROS 2's visualization_msgs: see ``kit.msg.visualization_msgs``."""
