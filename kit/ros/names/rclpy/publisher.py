from kit.ros.publisher import Publisher

__all__ = ["Publisher"]
