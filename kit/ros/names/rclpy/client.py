from kit.ros.node.client import Client

__all__ = ["Client"]
