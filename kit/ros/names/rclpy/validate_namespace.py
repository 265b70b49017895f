from kit.ros.graph.naming import validate_namespace

__all__ = ["validate_namespace"]
