"""Why a program could not be started or has failed, and what to do about a missing module."""

from __future__ import annotations

import re
import sys
from typing import Final

from kit.host.failure import Failure

_MISSING_MODULE: Final = re.compile(r"No module named '([\w.]+)'")
_MISSING_NAME: Final = re.compile(r"cannot import name '(\w+)' from '([\w.]+)'")

UNAVAILABLE_ROS_MODULES: Final = frozenset(
    {
        "cv_bridge", "image_geometry", "laser_geometry", "nav2_simple_commander", "pcl_ros",
        "rosbag2_py", "ros2cli", "rclpy_action", "tf2_kdl", "control_msgs", "map_msgs", "nav2_msgs", "xacro",
    }
)  # fmt: skip
"""Modules of ROS 2 that the kit does not have."""

PYPI_NAMES: Final = {
    "cv2": "opencv-python-headless",
    "PIL": "pillow",
    "yaml": "pyyaml",
    "sklearn": "scikit-learn",
}
"""The names in the package index of modules that are called otherwise there."""


class ProcessStartError(Exception):
    """A process cannot be started; the message says what is missing, and which line asked for it."""


class ProgramUnavailable(ProcessStartError):
    """A program of a kind that the kit does not run: a launch goes on without it."""


def explain_failure(failure: Failure) -> str:
    """The failure as text, with a suggestion on the next line if there is one."""
    hint = suggest_fix(failure.message)
    return f"{failure}\n{hint}" if hint else str(failure)


def suggest_fix(reason: str) -> str | None:
    """Suggests a remedy for a failed import, given its error message; None for other errors."""
    name = _MISSING_NAME.search(reason)
    if name is not None:
        return f"The kit's {name[2]} has no {name[1]}: it is a part of ROS 2 that the kit does not have."
    module = _MISSING_MODULE.search(reason)
    if module is None:
        return None
    top = module[1].partition(".")[0]
    if (
        top in UNAVAILABLE_ROS_MODULES
        or top.endswith(("_msgs", "_srvs", "_interfaces"))
        or top.startswith(("rclpy", "launch"))
    ):
        return f"{module[1]} is a part of ROS 2, or of another package, that is not here."
    return f"If {top} is a Python package: {sys.executable} -m pip install {PYPI_NAMES.get(top, top)}"
