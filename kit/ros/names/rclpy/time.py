from kit.ros.instants import Time

__all__ = ["Time"]
