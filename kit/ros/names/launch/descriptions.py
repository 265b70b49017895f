from kit.ros.launch.processes import Executable

__all__ = [
    "Executable",
]
