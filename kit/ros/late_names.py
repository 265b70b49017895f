"""Imports a name of a module when it is first used: for what would slow the start of every program."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from importlib import import_module
from typing import Any


def import_late_name(module: str, sources: Mapping[str, str], name: str) -> Any:
    """Returns the name of a module, which has it from now on; a module's ``__getattr__`` ends in this.

    ``sources``: where each such name lives, as ``MODULE:NAME``, or ``MODULE`` for a module. Raises AttributeError.
    """
    if name not in sources:
        raise AttributeError(f"module '{module}' has no attribute '{name}'")
    source, _, attribute = sources[name].partition(":")
    found: Any = import_module(source)
    value = getattr(found, attribute) if attribute else found
    setattr(sys.modules[module], name, value)
    return value
