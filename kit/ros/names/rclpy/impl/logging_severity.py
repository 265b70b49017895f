from kit.ros.log import LoggingSeverity

__all__ = ["LoggingSeverity"]
