from kit.ros.execution.client_library import ok, remove_ros_args, shutdown, timeout_sec_to_nsec, try_shutdown
from kit.ros.execution.context import get_default_context

__all__ = ["get_default_context", "ok", "remove_ros_args", "shutdown", "timeout_sec_to_nsec", "try_shutdown"]
