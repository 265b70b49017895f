from kit.ros.action.client import ActionClient, ClientGoalHandle

__all__ = ["ActionClient", "ClientGoalHandle"]
