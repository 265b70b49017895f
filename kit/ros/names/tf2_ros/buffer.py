from kit.ros.tf import Buffer

__all__ = ["Buffer"]
