from kit.ros.guard_condition import GuardCondition

__all__ = ["GuardCondition"]
