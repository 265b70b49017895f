from kit.ros.node.waitable import WaitableGuardCondition as GuardCondition

__all__ = ["GuardCondition"]
