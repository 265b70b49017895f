from kit.ros.transforms import Buffer

__all__ = ["Buffer"]
