"""ROS 2's sensor_msgs: see ``kit.msg.sensor_msgs``."""
