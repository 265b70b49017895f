from kit.ros.context import Context

__all__ = ["Context"]
