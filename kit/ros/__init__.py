"""ROS 2's Python API without ROS 2: nodes, topics, services, parameters and timers, as in rclpy.

``graph`` is the core. A program that imports ``rclpy``, ``std_msgs.msg`` and so on finds them once its process has
called ``install_import_names``. No other process does, so an installed ROS 2 does not interfere.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from kit.msg import install_ros_imports

NAMES_FOLDER: Final = os.path.join(os.path.dirname(__file__), "names")
"""The packages under ROS 2's import names, and the stubs of those of interfaces."""

SHIMS_FOLDER: Final = os.path.join(os.path.dirname(__file__), "shims")
"""Substitutes for old packages that programs written for Flatland import (``gym``, ``pynput``)."""


def install_import_names(interfaces: Mapping[str, str] = MappingProxyType({}), *, first: bool = True) -> None:
    """Makes ROS 2's import names known in this process, before what is really installed or after it.

    ``interfaces``: the folders of a workspace's packages with messages, services or actions, by their names.
    """
    sys.path.insert(0 if first else len(sys.path), NAMES_FOLDER)
    install_ros_imports(interfaces)
