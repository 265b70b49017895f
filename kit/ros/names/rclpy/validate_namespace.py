from kit.ros.naming import validate_namespace

__all__ = ["validate_namespace"]
