from kit.msg.builtin_interfaces import Duration, Time

__all__ = ["Duration", "Time"]
