from kit.ros.context import get_default_context
from kit.ros.running import ok, remove_ros_args, shutdown, timeout_sec_to_nsec, try_shutdown

__all__ = ["get_default_context", "ok", "remove_ros_args", "shutdown", "timeout_sec_to_nsec", "try_shutdown"]
