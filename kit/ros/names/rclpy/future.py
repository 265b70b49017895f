from kit.ros.task import Future

__all__ = ["Future"]
