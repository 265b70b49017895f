from kit.ros.launch.entity import Action

__all__ = [
    "Action",
]
