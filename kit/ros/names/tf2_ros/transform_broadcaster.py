from kit.ros.transforms import TransformBroadcaster

__all__ = ["TransformBroadcaster"]
