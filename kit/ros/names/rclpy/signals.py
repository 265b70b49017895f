from kit.ros.running import SignalHandlerOptions

__all__ = ["SignalHandlerOptions"]
