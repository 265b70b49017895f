from kit.ros.launch.event_handlers import OnProcessExit, OnProcessIO, OnProcessStart, OnShutdown

__all__ = ["OnProcessExit", "OnProcessIO", "OnProcessStart", "OnShutdown"]
