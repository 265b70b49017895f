from kit.ros.transforms import StaticTransformBroadcaster

__all__ = ["StaticTransformBroadcaster"]
