from kit.ros.launch.event_handlers import OnStateTransition

__all__ = ["OnStateTransition"]
