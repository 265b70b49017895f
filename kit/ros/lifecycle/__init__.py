"""Lifecycle nodes: nodes that are configured, activated and shut down from outside. See ``rclpy.lifecycle``."""
