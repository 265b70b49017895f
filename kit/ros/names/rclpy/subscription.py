from kit.ros.subscription import MessageInfo, Subscription

__all__ = ["MessageInfo", "Subscription"]
