"""ROS 2's Python API without ROS 2: nodes, topics, services, parameters and timers, as in rclpy.

``graph`` is the core. A program that imports ``rclpy``, ``std_msgs.msg`` and so on finds them in ``names_folder()``,
which the process that runs such a program puts first on ``sys.path``. No other process does, so an installed ROS 2 does
not interfere.
"""

from __future__ import annotations


def names_folder() -> str:
    """The folder of packages under ROS 2's import names. Made without ``pathlib``, a twentieth of a node's start-up."""
    return f"{__path__[0]}/names"


def shims_folder() -> str:
    """The folder of substitutes for old packages that programs written for Flatland import (``gym``, ``pynput``)."""
    return f"{__path__[0]}/shims"
