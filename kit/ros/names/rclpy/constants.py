from kit.ros.node.time import S_TO_NS

__all__ = ["S_TO_NS"]
