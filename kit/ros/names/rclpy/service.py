from kit.ros.service import Service

__all__ = ["Service"]
