from kit.ros.lifecycle import ManagedEntity, SimpleManagedEntity

__all__ = ["ManagedEntity", "SimpleManagedEntity"]
