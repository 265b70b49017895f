from kit.ros.node.publisher import Publisher

__all__ = ["Publisher"]
