"""Software that launch files often ask for and the kit does not have: what it is, and what is done without it.

A launch file may import it, as ``import xacro`` at its top: what uses it is skipped.
"""

from __future__ import annotations

import importlib.abc
import importlib.machinery
import re
import sys
from collections.abc import Sequence
from types import MappingProxyType, ModuleType
from typing import Any, Final, NoReturn

from kit.ros.launch.context import LaunchContext, LaunchError
from kit.ros.launch.entity import Action, Condition
from kit.ros.launch.substitutions import Substitution

UNAVAILABLE_FOLDER: Final = "/not-available-in-the-kit"
"""Where the share folders of such packages would lie: nothing is there, so that what needs a file of them is noticed."""

_GAZEBO: Final = "Gazebo is a simulator of its own; the kit's worlds take its place"
_NAVIGATION: Final = "navigation is C++ that the kit does not have"
_SOFTWARE: Final = MappingProxyType(
    {
        r"gazebo\w*|gz|gzserver|gzclient|ign|ros_gz\w*|ros_ign\w*|gz_\w+|ign_\w+|turtlebot3_gazebo": _GAZEBO,
        r"xacro": "xacro makes robot descriptions, which the kit's models do not need",
        r"robot_state_publisher|joint_state_publisher\w*|urdf|urdf_\w+": (
            "it publishes transforms from a robot description; the kit's models publish theirs themselves"
        ),
        r"nav2\w*|navigation2|slam_toolbox|cartographer\w*|amcl|robot_localization": _NAVIGATION,
        r"controller_manager|ros2_control\w*|ros2_controllers|diff_drive_controller|joint_trajectory_controller": (
            "ros2_control is C++; the kit's models have their drives built in"
        ),
        r"moveit\w*": "MoveIt is C++ that the kit does not have",
        r"rqt\w*|plotjuggler": "it needs a desktop; `kit ros` and the nodes screen show what runs",
        r"webots\w*": "Webots is a simulator of its own; the kit's worlds take its place",
        r"usb_cam|v4l2_camera|image_tools|realsense2_camera|cv_bridge": "cameras are hardware that is not here",
        r"demo_nodes_cpp|examples_rclcpp\w*|composition|intra_process_demo|lifecycle": (
            "its programs are C++; demo_nodes_py has the same talker, listener and sum"
        ),
        r"micro_ros_agent|rosbridge_server|foxglove_bridge": "it connects to other machines, and launch files here start programs on this one alone; `kit bridge` connects to a robot",
    }
)
"""What such software is, by a pattern of the names of packages and programs."""


class SoftwareUnavailable(LaunchError):
    """Something that the kit does not have is needed; the action is skipped and the launch goes on."""


def describe_unavailable(name: str) -> str | None:
    """What a package or program is that the kit does not have; None for any other name."""
    return next((text for pattern, text in _SOFTWARE.items() if re.fullmatch(pattern, name)), None)


def require_available(name: str) -> None:
    """Raises SoftwareUnavailable if a package or program is one that the kit does not have."""
    what = describe_unavailable(name)
    if what is not None:
        raise SoftwareUnavailable(f"{name} is not in the kit: {what}")


def require_available_path(path: str) -> None:
    """As ``require_available``, for a path in the share folder of such a package."""
    if path.startswith(UNAVAILABLE_FOLDER + "/"):
        require_available(path.removeprefix(UNAVAILABLE_FOLDER + "/").partition("/")[0])


class UnavailableObject(Action, Substitution):
    """Whatever such a module holds, returns or makes: it can be named, called and passed on, but not carried out.

    As an action it is skipped, and so is an action that takes it as a text or a parameter.
    """

    def __init__(self, software: str, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self._software = software

    def __call__(self, *_: Any, **__: Any) -> UnavailableObject:
        return UnavailableObject(self._software)

    def __getattr__(self, name: str) -> UnavailableObject:
        if name.startswith("__"):  # what Python itself asks for
            raise AttributeError(name)
        return UnavailableObject(self._software)

    def execute(self, context: LaunchContext) -> NoReturn:
        require_available(self._software)
        raise AssertionError(self._software)

    def perform(self, context: LaunchContext) -> NoReturn:
        self.execute(context)

    def describe(self) -> str:
        return f"{self._software} (not in the kit)"

    def __str__(self) -> NoReturn:
        """Refuses to become part of a text, which would be a wrong one. Raises SoftwareUnavailable."""
        require_available(self._software)
        raise AssertionError(self._software)


class _UnavailableModules(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Finds a module for each name of software that ``describe_unavailable`` knows."""

    def find_spec(
        self, name: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        if describe_unavailable(name.partition(".")[0]) is None:
            return None
        return importlib.machinery.ModuleSpec(name, self, is_package=True)

    def exec_module(self, module: ModuleType) -> None:
        held = UnavailableObject(module.__name__.partition(".")[0])
        module.__dict__["__getattr__"] = held.__getattr__


def install_unavailable_imports() -> None:
    """Makes such imports succeed in this process. What is really installed is found first."""
    sys.meta_path.append(_UnavailableModules())
