"""ROS 2's Python API without ROS 2: nodes, topics, services, parameters and timers, as in rclpy.

``graph`` is the core. A program that imports ``rclpy``, ``std_msgs.msg`` and so on finds them in ``names_folder()``,
which the process that runs such a program puts first on ``sys.path``. No other process does, so an installed ROS 2 does
not interfere.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path


def names_folder() -> Path:
    """The folder of packages under ROS 2's import names."""
    from pathlib import Path  # imported here: it takes a fifth of a node's start-up, and few programs need it

    return Path(__file__).parent / "names"


def shims_folder() -> Path:
    """The folder of substitutes for old packages that programs written for Flatland import (``gym``, ``pynput``)."""
    from pathlib import Path

    return Path(__file__).parent / "shims"
