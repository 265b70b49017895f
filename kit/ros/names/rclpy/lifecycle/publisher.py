from kit.ros.lifecycle.managed_entity import LifecyclePublisher

__all__ = ["LifecyclePublisher"]
