"""ROS 2 message and service classes, without ROS: ``from kit.msg.geometry_msgs import Twist``.

They behave as the classes ROS 2 generates for Python, and load neither numpy nor anything else heavy. ``kit.msg`` has
a module for each ROS package in ``definitions``, and ``install_ros_imports`` adds those under ROS 2's own names,
``geometry_msgs.msg``. No file holds them: a finder makes them, and their classes are built at first use.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Mapping, Sequence
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import Any

from kit.msg.renamed_packages import RENAMED_PACKAGES

_DEFINITIONS = os.path.join(os.path.dirname(__file__), "definitions")
_SHIPPED = {package: os.path.join(_DEFINITIONS, package) for package in os.listdir(_DEFINITIONS)}
"""The folders of the packages whose definitions are shipped, by their names."""
_PARTS = ("msg", "srv", "action")


def install_ros_imports(folders: Mapping[str, str]) -> None:
    """Lets this process import interfaces as ROS does: ``from geometry_msgs.msg import Twist``.

    ``folders``: the source folders of a workspace's packages, by their names; they are registered too.
    """
    if folders:
        from kit.msg.interfaces import register_packages

        register_packages(folders)
    # First, since a package's folder on the path would be found as a namespace; a package of a workspace itself last,
    # since its own Python modules come before.
    sys.meta_path.insert(0, _RosFinder({**folders, **_SHIPPED}))
    sys.meta_path.append(_PackageFinder(folders))


class _KitFinder:
    """Finds ``kit.msg.PACKAGE``: all interfaces of a shipped package."""

    def find_spec(
        self, name: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        package = name.removeprefix(f"{__name__}.")
        if package == name or package not in _SHIPPED:
            return None
        loader: Any = _InterfaceLoader(
            package, _PARTS
        )  # as importlib asks for, without importing importlib.abc
        return ModuleSpec(name, loader)


class _RosFinder:
    """Finds ``PACKAGE.msg``, ``PACKAGE.srv`` and ``PACKAGE.action``, and the packages of shipped ones."""

    def __init__(self, folders: Mapping[str, str]) -> None:
        self._folders = folders

    def find_spec(
        self, name: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        package, _, part = name.partition(".")
        if not part and package in RENAMED_PACKAGES:
            return _package_spec(name)
        package = RENAMED_PACKAGES.get(package, package)
        if package not in self._folders:
            return None
        if not part:
            return _package_spec(name) if package in _SHIPPED else None
        part, _, generated = part.partition(".")
        if generated:  # as rosidl makes them: geometry_msgs.msg._twist
            is_found = part in _PARTS and self._has_generated(package, part, generated)
            return ModuleSpec(name, _loader(package, part)) if is_found else None
        if part not in _PARTS or not _has_definitions(self._folders[package], part):
            return None
        return ModuleSpec(name, _loader(package, part), is_package=True)

    def _has_generated(self, package: str, part: str, module: str) -> bool:
        """Whether rosidl would make this module: the name of an interface, ``_laser_scan`` for LaserScan."""
        names = (file.removesuffix(f".{part}") for file in _definition_files(self._folders[package], part))
        return module in {f"_{snake_case(name)}" for name in names}


class _PackageFinder:
    """Finds a package that has interfaces but no Python module of its name."""

    def __init__(self, folders: Mapping[str, str]) -> None:
        self._folders = folders

    def find_spec(
        self, name: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        return _package_spec(name) if name in self._folders else None


class _EmptyLoader:
    def create_module(self, spec: ModuleSpec) -> None:
        """Leaves the creation to Python."""

    def exec_module(self, module: ModuleType) -> None:
        """Adds nothing."""


class _InterfaceLoader(_EmptyLoader):
    """Loads the module of a package's interfaces of some kinds: classes are built at first use."""

    def __init__(self, package: str, parts: tuple[str, ...]) -> None:
        self._package = package
        self._parts = parts

    def exec_module(self, module: ModuleType) -> None:
        from kit.msg.interfaces import package_attribute

        module.__dict__["__getattr__"] = lambda name: package_attribute(
            module.__name__, self._package, self._parts, name
        )


def _package_spec(name: str) -> ModuleSpec:
    loader: Any = _EmptyLoader()
    return ModuleSpec(name, loader, is_package=True)


def _loader(package: str, part: str) -> Any:
    """Makes a loader of one kind of a package's interfaces."""
    return _InterfaceLoader(package, (part,))


def _has_definitions(folder: str, part: str) -> bool:
    return bool(_definition_files(folder, part))


def _definition_files(folder: str, part: str) -> list[str]:
    try:
        return [file for file in os.listdir(os.path.join(folder, part)) if file.endswith(f".{part}")]
    except OSError:  # a package need not have each kind
        return []


def snake_case(name: str) -> str:
    """Returns the name of the module that rosidl makes for an interface: ``laser_scan``, ``tf_message``, ``pose2_d``."""
    name = re.sub(r"(.)([A-Z][a-z]+)", r"\1_\2", name)
    return re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", name).lower()


sys.meta_path.append(_KitFinder())
