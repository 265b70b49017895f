from kit.ros.node.waitable import NumberOfEntities, Waitable

__all__ = ["NumberOfEntities", "Waitable"]
