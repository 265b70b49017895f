from kit.ros.launch.events import ChangeState, StateTransition

__all__ = ["ChangeState", "StateTransition"]
