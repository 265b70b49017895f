"""rclpy.impl.implementation_singleton of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from typing import TYPE_CHECKING, Any

from kit.ros.late_names import import_late_name

if TYPE_CHECKING:
    import_c_library: Any
    package: Any
    rclpy_implementation: Any
else:
    _LATE_NAMES = {
        "import_c_library": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "package": "!rclpy's library in C, in whose place the kit has a graph of its own",
        "rclpy_implementation": "!rclpy's library in C, in whose place the kit has a graph of its own",
    }

    def __getattr__(name):
        return import_late_name(__name__, _LATE_NAMES, name)
