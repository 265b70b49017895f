from kit.ros.node.time import Duration, Infinite

__all__ = ["Duration", "Infinite"]
