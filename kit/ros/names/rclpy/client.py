from kit.ros.client import Client

__all__ = ["Client"]
