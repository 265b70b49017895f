from kit.ros.instants import Duration, Infinite

__all__ = ["Duration", "Infinite"]
