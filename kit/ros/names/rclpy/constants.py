from kit.ros.instants import S_TO_NS

__all__ = ["S_TO_NS"]
