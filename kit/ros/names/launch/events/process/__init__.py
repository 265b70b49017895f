from kit.ros.launch.events import ProcessExited, ProcessIO, ProcessStarted, ShutdownProcess, SignalProcess

__all__ = ["ProcessExited", "ProcessIO", "ProcessStarted", "ShutdownProcess", "SignalProcess"]
