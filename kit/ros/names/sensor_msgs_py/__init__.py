"""Helpers for sensor messages, under the name of ROS 2's sensor_msgs_py."""
