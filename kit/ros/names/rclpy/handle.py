from kit.ros.exceptions import InvalidHandle

__all__ = ["InvalidHandle"]
