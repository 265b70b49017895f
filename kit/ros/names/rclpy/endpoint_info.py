"""rclpy.endpoint_info of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.node.endpoint import (
    TopicEndpointInfo,
    TopicEndpointTypeEnum as EndpointTypeEnum,
    TopicEndpointTypeEnum,
)

__all__ = ["EndpointTypeEnum", "TopicEndpointInfo", "TopicEndpointTypeEnum"]
