from kit.ros.lifecycle import LifecyclePublisher

__all__ = ["LifecyclePublisher"]
