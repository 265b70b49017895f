"""Lets a launch file import modules that the kit does not have, as ``import xacro`` at its top: what uses them is skipped."""

from __future__ import annotations

import importlib.abc
import importlib.machinery
import sys
from collections.abc import Sequence
from types import ModuleType
from typing import Any, NoReturn

from kit.ros.launch.conditions import Condition
from kit.ros.launch.context import LaunchContext
from kit.ros.launch.entity import Action
from kit.ros.launch.substitutions import Substitution
from kit.ros.launch.unavailable import describe_unavailable, require_available


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
