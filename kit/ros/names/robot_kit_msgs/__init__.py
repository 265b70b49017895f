"""ROS 2's robot_kit_msgs: see ``kit.msg.robot_kit_msgs``."""
