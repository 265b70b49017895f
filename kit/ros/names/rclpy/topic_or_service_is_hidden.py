from kit.ros.graph.naming import topic_or_service_is_hidden

__all__ = ["topic_or_service_is_hidden"]
