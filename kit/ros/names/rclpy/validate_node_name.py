from kit.ros.graph.naming import validate_node_name

__all__ = ["validate_node_name"]
