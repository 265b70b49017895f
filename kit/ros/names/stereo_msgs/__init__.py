"""ROS 2's stereo_msgs: see ``kit.msg.stereo_msgs``."""
