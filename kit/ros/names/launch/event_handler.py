from kit.ros.launch.event_handlers import EventHandler

__all__ = ["EventHandler"]
