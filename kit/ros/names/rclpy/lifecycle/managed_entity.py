from kit.ros.lifecycle.node import ManagedEntity, SimpleManagedEntity

__all__ = ["ManagedEntity", "SimpleManagedEntity"]
