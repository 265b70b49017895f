"""What to do about something that a package needs and that is not here."""

from __future__ import annotations

import re
import sys
from typing import Final

from kit.host.failure import Failure

_MISSING: Final = re.compile(r"No module named '([\w.]+)'")
_NOT_IN: Final = re.compile(r"cannot import name '(\w+)' from '([\w.]+)'")

PARTS_OF_ROS: Final = frozenset(
    {
        "cv_bridge", "image_geometry", "laser_geometry", "message_filters", "nav2_simple_commander", "pcl_ros",
        "rosbag2_py", "ros2cli", "rclpy_action", "sensor_msgs_py", "tf2_geometry_msgs", "tf2_kdl", "turtlesim",
        "action_msgs", "control_msgs", "map_msgs", "nav2_msgs", "stereo_msgs", "actionlib_msgs", "lifecycle_msgs",
    }
)  # fmt: skip
"""Modules of ROS 2 that the kit does not have."""

OTHER_NAMES: Final = {
    "cv2": "opencv-python-headless",
    "PIL": "pillow",
    "yaml": "pyyaml",
    "sklearn": "scikit-learn",
}
"""What some modules are called in the package index."""


def explained(failure: Failure) -> str:
    """A failure, and on the next line the way out, if there is one."""
    hint = advice(failure.message)
    return f"{failure}\n{hint}" if hint else str(failure)


def advice(reason: str) -> str | None:
    """A sentence on the way out, for the reason why a program has ended; None if there is none."""
    name = _NOT_IN.search(reason)
    if name is not None:
        return f"The kit's {name[2]} has no {name[1]}: it is a part of ROS 2 that the kit does not have."
    module = _MISSING.search(reason)
    if module is None:
        return None
    top = module[1].partition(".")[0]
    if (
        top in PARTS_OF_ROS
        or top.endswith(("_msgs", "_srvs", "_interfaces"))
        or top.startswith(("rclpy", "launch"))
    ):
        return f"{module[1]} is a part of ROS 2, or of another package, that is not here."
    return f"If {top} is a Python package: {sys.executable} -m pip install {OTHER_NAMES.get(top, top)}"
