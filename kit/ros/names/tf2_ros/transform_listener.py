from kit.ros.transforms import TransformListener

__all__ = ["TransformListener"]
