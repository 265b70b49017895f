"""Actions: goals that take their time, with feedback, a result and a way to cancel them. See ``rclpy.action``."""
