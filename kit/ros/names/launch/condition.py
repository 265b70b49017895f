from kit.ros.launch.entity import Condition

__all__ = ["Condition"]
