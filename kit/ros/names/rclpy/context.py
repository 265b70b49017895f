from kit.ros.execution.context import Context

__all__ = ["Context"]
