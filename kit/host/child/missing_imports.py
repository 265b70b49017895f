"""What a program's import that fails was probably meant to be, and where what it asks for is to be had."""

from __future__ import annotations

import os
import re
import sys
from types import ModuleType
from typing import Final

from kit.ros import NAMES_FOLDER

MAX_LEVELS: Final = 6
"""How many folders above a program's file are searched for what it could not import."""
INTERFACES: Final = ("_msgs", "_srvs", "_interfaces")
"""How packages of interfaces are named."""
SURE: Final = 0.9
"""How alike the name of a package of interfaces must be to one that is there: many differ by few letters."""
ROS_MODULE: Final = re.compile(
    r"rclpy\w*|launch\w*|ros2\w*|rosidl\w*|tf2_\w+|image_geometry|laser_geometry|pcl_ros|rospy|roslib|tf|diagnostic_updater"
)
"""Modules of ROS that the kit does not have, beside the software that ``describe_unavailable`` knows."""
PYPI_NAMES: Final = {
    "cv2": "opencv-python-headless",
    "PIL": "pillow",
    "serial": "pyserial",
    "skimage": "scikit-image",
    "sklearn": "scikit-learn",
    "usb": "pyusb",
    "yaml": "pyyaml",
    "zmq": "pyzmq",
}
"""The names in the package index of modules that are called otherwise there."""

_MISSING_NAME: Final = re.compile(r"cannot import name '(\w+)' from '[\w.]+' \(")


def import_way_out(problem: ImportError, file: str) -> str:
    """Returns the end of the message about an import of a program's ``file`` that failed; empty if it says enough."""
    if not isinstance(problem.name, str):
        return ""
    if isinstance(problem, ModuleNotFoundError):
        if str(problem) != f"No module named '{problem.name}'":  # it says more already
            return ""
        return _of_module(problem.name, file)
    missing, module = _MISSING_NAME.match(str(problem)), sys.modules.get(problem.name)
    return "" if missing is None or module is None else _of_name(missing[1], module)


def nearest(name: str, known: set[str], cutoff: float = 0.75) -> str:
    """Returns the question whether the nearest of the known names was meant; empty if none is near."""
    from difflib import get_close_matches  # here: only a mistake needs it

    near = get_close_matches(name, sorted(known), 1, cutoff)
    return f". Did you mean '{near[0]}'?" if near and near[0] != name else ""


def _of_module(name: str, file: str) -> str:
    from pkgutil import iter_modules  # these here: only a mistake needs them

    from kit.msg.interfaces import known_packages
    from kit.ros.launch.unavailable import describe_unavailable

    top = name.partition(".")[0]
    nearby = _module_nearby(top, file)
    if nearby is not None:
        return (
            f". {nearby} lies nearby, but Python does not find it from here: run the program as a part of its "
            "package, `kit ros run PACKAGE PROGRAM`, or move the file beside that folder."
        )
    parent = sys.modules.get(name.rpartition(".")[0])
    if parent is not None:
        last = name.rpartition(".")[2]
        return nearest(last, _importable_names(parent)) or _missing_name_text(parent, last)
    what = describe_unavailable(top)
    if what is not None:
        return f". {top} is not in the kit: {what}."
    is_interfaces = top.endswith(INTERFACES)
    known = {*sys.stdlib_module_names, *(found.name for found in iter_modules()), *known_packages()}
    meant = nearest(top, known, SURE) if is_interfaces else nearest(top, known)
    if meant:
        return meant
    if is_interfaces:
        return (
            f". The kit does not have these interfaces; the source folder of {top}, with its package.xml, beside the "
            "program's own package makes them known."
        )
    if ROS_MODULE.fullmatch(top):
        return f". {top} belongs to ROS, and is not in the kit."
    return (
        ". If the name is right, install it in the environment that runs the kit: "
        f"pip install {PYPI_NAMES.get(top, top)}"
    )


def _of_name(name: str, module: ModuleType) -> str:
    return nearest(name, _importable_names(module)) or _missing_name_text(module, name)


def _importable_names(module: ModuleType) -> set[str]:
    """The names that can be imported from a module: its own, its submodules', and those of interfaces not built yet."""
    from pkgutil import iter_modules  # these here: only a mistake needs them

    from kit.msg.interfaces import interface_names, known_packages

    names = {name for name in dir(module) if name[:1] != "_"}
    names |= {found.name for found in iter_modules(getattr(module, "__path__", ()))}
    package, _, part = module.__name__.partition(".")
    if package in known_packages():
        prefix = f"{package}/{part}/"
        names |= {name.removeprefix(prefix) for name in interface_names(package) if name.startswith(prefix)}
    return names


def _missing_name_text(module: ModuleType, name: str) -> str:
    """Says that a module of ROS 2 as the kit has it lacks a name; of other modules Python has said so."""
    from kit.msg.interfaces import known_packages  # here: only a mistake needs it

    file = getattr(module, "__file__", None) or ""
    is_kits = file.startswith(NAMES_FOLDER + os.sep) or module.__name__.partition(".")[0] in known_packages()
    return f". The kit's {module.__name__} has no {name}." if is_kits else ""


def _module_nearby(name: str, file: str) -> str | None:
    """Returns a folder or a module of this name beside the program's file, or beside one of the folders that hold it."""
    folder = os.path.dirname(file)
    for _ in range(MAX_LEVELS):
        if folder in ("", os.sep):
            break
        for found in (os.path.join(folder, name), os.path.join(folder, f"{name}.py")):
            if os.path.exists(found):
                return found
        folder = os.path.dirname(folder)
    return None
