from kit.ros.node.endpoint import GuardCondition

__all__ = ["GuardCondition"]
