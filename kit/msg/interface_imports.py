"""Makes a workspace's own interfaces importable as ROS does: ``from my_msgs.msg import Reading``."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import Any

from kit.msg.definition_parser import SECTIONS
from kit.msg.interfaces import interface_names, known_packages, package_attribute, register_packages


def install_interface_imports(folders: Mapping[str, str]) -> None:
    """Registers packages by their folders, and lets this process import their interfaces."""
    if not folders:
        return
    register_packages(folders)
    # First, since a package's folder on the path would be found as a namespace; for the package itself last,
    # since its own Python modules come before.
    sys.meta_path.insert(0, _PartFinder())
    sys.meta_path.append(_PackageFinder())


class _PartFinder:
    """Finds ``PACKAGE.msg``, ``PACKAGE.srv`` and ``PACKAGE.action``."""

    def find_spec(
        self, name: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        package, _, part = name.partition(".")
        if part not in SECTIONS or package not in known_packages():
            return None
        if not any(full_name.split("/")[1] == part for full_name in interface_names(package)):
            return None
        loader: Any = _PartLoader(package, part)  # as importlib asks for, without importing importlib.abc
        return ModuleSpec(name, loader, is_package=True)


class _PackageFinder:
    """Finds a package that has interfaces but no Python module of its name."""

    def find_spec(
        self, name: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        loader: Any = _EmptyLoader()  # likewise
        return ModuleSpec(name, loader, is_package=True) if name in known_packages() else None


class _EmptyLoader:
    def create_module(self, spec: ModuleSpec) -> None:
        """Leaves the creation to Python."""

    def exec_module(self, module: ModuleType) -> None:
        """Adds nothing."""


class _PartLoader(_EmptyLoader):
    """Loads the module of one kind of interfaces of a package: classes are built at first use."""

    def __init__(self, package: str, part: str) -> None:
        self._package = package
        self._part = part

    def exec_module(self, module: ModuleType) -> None:
        module.__dict__["__getattr__"] = lambda name: package_attribute(
            module.__name__, self._package, (self._part,), name
        )
