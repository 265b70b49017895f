from kit.ros.launch.events import ChangeState

__all__ = ["ChangeState"]
