"""Keyboard teleoperation, as an ordinary rclpy node."""
