from kit.ros.execution.task import Future

__all__ = ["Future"]
