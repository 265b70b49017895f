from kit.ros.node.time import Time

__all__ = ["Time"]
