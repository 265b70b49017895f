from kit.ros.tf import TransformListener

__all__ = ["TransformListener"]
