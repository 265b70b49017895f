from kit.ros.node.service import Service

__all__ = ["Service"]
