from kit.ros.log import RcutilsLogger

__all__ = ["RcutilsLogger"]
