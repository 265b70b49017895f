"""Calls from other threads into the loop that draws."""

from __future__ import annotations

from asyncio import get_running_loop
from collections.abc import Callable
from contextlib import suppress
from contextvars import copy_context
from typing import ParamSpec

P = ParamSpec("P")


def called_in_loop(function: Callable[P, object]) -> Callable[P, None]:
    """Returns what another thread calls to have ``function`` called, soon, in the loop that runs now; nothing comes of it once
    the face has been left."""
    loop, context = get_running_loop(), copy_context()

    def call(*args: P.args, **kwargs: P.kwargs) -> None:
        with suppress(RuntimeError):  # the loop has ended
            loop.call_soon_threadsafe(lambda: function(*args, **kwargs), context=context)

    return call
