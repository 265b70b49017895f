from kit.ros.graph.naming import expand_topic_name

__all__ = ["expand_topic_name"]
