"""Finds the goals there are: every module of this folder may define one."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib import import_module
from pkgutil import iter_modules
from types import MappingProxyType

from kit.learning.tasks.goals.goal import Goal
from kit.learning.tasks.goals.target import REACH_TARGET
from kit.world.yaml_section import Section


@cache
def goal_kinds() -> Mapping[str, type[Goal]]:
    """The classes of all goals by ``kind``, in the order of their names."""
    package = __name__.rpartition(".")[0]
    modules = [
        import_module(f"{package}.{found.name}") for found in iter_modules(import_module(package).__path__)
    ]
    classes = {
        value
        for module in modules
        for value in vars(module).values()
        if isinstance(value, type) and issubclass(value, Goal) and value.__module__ == module.__name__
    }
    return MappingProxyType(
        {each.kind: each for each in sorted(classes - {Goal}, key=lambda goal: goal.kind)}
    )


def read_goal(section: Section | None) -> Goal:
    """The goal that a file's section ``goal`` describes; without one robots are to be in the target."""
    if section is None:
        return REACH_TARGET
    kind = section.choice("kind", goal_kinds())
    goal = REACH_TARGET if kind is None else kind.read(section)
    section.finish(ignore_unknown=kind is None)
    return goal
