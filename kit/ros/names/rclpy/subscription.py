from kit.ros.node.subscription import MessageInfo, Subscription

__all__ = ["MessageInfo", "Subscription"]
