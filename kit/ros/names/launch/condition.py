from kit.ros.launch.conditions import Condition

__all__ = ["Condition"]
