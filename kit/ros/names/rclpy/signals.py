from kit.ros.execution.client_library import SignalHandlerOptions

__all__ = ["SignalHandlerOptions"]
