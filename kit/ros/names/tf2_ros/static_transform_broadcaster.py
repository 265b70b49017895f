from kit.ros.tf import StaticTransformBroadcaster

__all__ = ["StaticTransformBroadcaster"]
