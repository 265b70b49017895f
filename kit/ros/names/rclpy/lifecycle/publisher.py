from kit.ros.lifecycle.node import LifecyclePublisher

__all__ = ["LifecyclePublisher"]
