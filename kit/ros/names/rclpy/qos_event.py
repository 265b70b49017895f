from rclpy.event_handler import *  # noqa: F403 - the name of rclpy.event_handler before Iron
from rclpy.event_handler import __all__ as __all__
