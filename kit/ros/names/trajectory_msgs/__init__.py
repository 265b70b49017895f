"""ROS 2's trajectory_msgs: see ``kit.msg.trajectory_msgs``."""
