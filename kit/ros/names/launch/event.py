from kit.ros.launch.events import Event

__all__ = [
    "Event",
]
