"""ROS 2's conversation, without ROS: nodes, topics, services, parameters and timers in rclpy's shape.

``graph`` is the middle of it. A program that imports ``rclpy``, ``std_msgs.msg`` and so on finds them in
``names_folder()``, which whoever runs such a program puts first on its ``sys.path``; nobody else does, so an
installed ROS 2 is never in the way.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path


def names_folder() -> Path:
    """The folder of packages under ROS 2's import names."""
    from pathlib import Path  # a fifth of the time that starting a node takes, and few need it

    return Path(__file__).parent / "names"


def shims_folder() -> Path:
    """The folder of packages that stand in for what packages of Flatland's time import and is not installed."""
    from pathlib import Path

    return Path(__file__).parent / "shims"
