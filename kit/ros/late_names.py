"""Imports a name of a module when it is first used: for what would slow the start of every program.

Makes classes that stand for the names of ROS 2 that the kit does not have, so that an import of one succeeds and its use
says what it would need.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from importlib import import_module
from importlib.util import find_spec
from typing import Any, Final, NoReturn

ABSENT: Final = "!"
"""Begins the source of a name that the kit does not have; what it would need follows."""


class AbsentNameError(NotImplementedError):
    """A program uses something of ROS 2 that the kit does not have."""


class _AbsentType(type):
    """The type of the classes that stand for absent names: nothing can be called or read from them."""

    needs: str

    def _refuse(cls) -> NoReturn:
        raise AbsentNameError(f"{cls.__module__}.{cls.__qualname__} is not in the kit: it needs {cls.needs}")

    def __call__(cls, *args: Any, **kwargs: Any) -> NoReturn:
        cls._refuse()

    def __getattr__(cls, name: str) -> NoReturn:
        if name.startswith("__"):  # what Python itself asks for
            raise AttributeError(name)
        cls._refuse()

    def __getitem__(cls, item: Any) -> type:
        return cls  # of an annotation


def make_absent_name(module: str, name: str, needs: str) -> type:
    """Returns the class that stands for a name that the kit does not have: may be imported, annotated with, derived from."""
    return _AbsentType(name, (), {"__module__": module, "__doc__": f"Needs {needs}.", "needs": needs})


def is_absent_name(value: object) -> bool:
    """Returns whether a name's value is a class of ``make_absent_name``."""
    return isinstance(value, _AbsentType)


def import_late_name(module: str, sources: Mapping[str, str], name: str) -> Any:
    """Returns the name of a module, which has it from now on; a module's ``__getattr__`` ends in this.

    ``sources``: where each such name lives, as ``MODULE:NAME``, or ``MODULE`` for a module; for a name that the kit does
    not have, ``!`` and what it would need. A module within this one is one of its names too: in ROS 2, something has imported
    it by then. Raises AttributeError.
    """
    source = sources.get(name)
    if source is None:
        source = f"{module}.{name}"
        if name.startswith("_") or not hasattr(sys.modules[module], "__path__") or find_spec(source) is None:
            raise AttributeError(f"module '{module}' has no attribute '{name}'")
    if source.startswith(ABSENT):
        value: Any = make_absent_name(module, name, source.removeprefix(ABSENT))
    else:
        home, _, attribute = source.partition(":")
        found: Any = import_module(home)
        value = getattr(found, attribute) if attribute else found
    setattr(sys.modules[module], name, value)
    return value
