from kit.ros.lifecycle.managed_entity import ManagedEntity, SimpleManagedEntity

__all__ = ["ManagedEntity", "SimpleManagedEntity"]
