from kit.ros.launch.events import matches_node_name

__all__ = [
    "matches_node_name",
]
