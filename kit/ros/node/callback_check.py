"""Looks at a callback before it is kept: a mistake shows where it was made, not when the first message comes."""

from __future__ import annotations

import inspect
from collections.abc import Sequence
from typing import Any


def accepted_argument_count(callback: Any, allowed: Sequence[int], what: str) -> int:
    """With how many arguments to call it: the first number of ``allowed`` that it accepts.

    Raises TypeError if it cannot be called, or with none of these numbers.
    """
    if not callable(callback):
        hint = " (give the function itself, without parentheses)" if callback is None else ""
        raise TypeError(f"the callback of {what} must be a function, not {type(callback).__name__}{hint}")
    try:
        signature = inspect.signature(callback)
    except ValueError:  # some built-in functions do not tell
        return allowed[0]
    for count in allowed:
        try:
            signature.bind(*range(count))
        except TypeError:
            continue
        return count
    name = getattr(callback, "__qualname__", repr(callback))
    counts = " or ".join(str(count) for count in allowed)
    raise TypeError(
        f"the callback of {what} is called with {counts} argument(s), but {name}{signature} takes others"
    )
