from kit.ros.node.guard_condition import GuardCondition

__all__ = ["GuardCondition"]
