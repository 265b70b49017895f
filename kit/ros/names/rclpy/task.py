from kit.ros.task import Future, Task

__all__ = ["Future", "Task"]
