from kit.ros.launch.events import ChangeState, StateTransition, matches_node_name

__all__ = [
    "ChangeState",
    "StateTransition",
    "matches_node_name",
]
