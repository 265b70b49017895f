from kit.ros.tf import TransformBroadcaster

__all__ = ["TransformBroadcaster"]
