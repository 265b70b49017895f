from kit.ros.graph.naming import validate_parameter_name

__all__ = ["validate_parameter_name"]
