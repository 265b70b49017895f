from kit.ros.execution.client_library import wait_for_message

__all__ = ["wait_for_message"]
