"""ROS 2's action_msgs: see ``kit.msg.action_msgs``."""
