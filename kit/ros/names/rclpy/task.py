from kit.ros.execution.task import Future, Task

__all__ = ["Future", "Task"]
