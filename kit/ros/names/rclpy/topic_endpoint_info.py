from kit.ros.endpoint_info import TopicEndpointInfo, TopicEndpointTypeEnum

__all__ = ["TopicEndpointInfo", "TopicEndpointTypeEnum"]
