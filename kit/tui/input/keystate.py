"""Which keys are down: a pure state machine, told of presses, repeats and releases, that tells transitions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import NamedTuple

from kit.tui.input.keys import base_key


class KeyTransition(NamedTuple):
    """A key went down or up at ``time`` [s] of the clock."""

    key: str
    down: bool
    time: float


class KeyState:
    """Keys by their base name, because a release carries the modifiers of its own moment, not of the press.

    ``clock`` gives seconds.
    """

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._held: dict[str, float] = {}

    @property
    def held(self) -> Mapping[str, float]:
        """The keys that are down, longest first, and since when [s]."""
        return MappingProxyType(self._held)

    def press(self, key: str) -> tuple[KeyTransition, ...]:
        """The key goes down, unless it is down: without release events every repeat looks like a press."""
        key = base_key(key)
        if key in self._held:
            return ()
        self._held[key] = self._clock()
        return (KeyTransition(key, True, self._held[key]),)

    def repeat(self, key: str) -> tuple[KeyTransition, ...]:
        """Changes nothing. A repeat of a key that is up belongs to a press from before ``clear``."""
        return ()

    def release(self, key: str) -> tuple[KeyTransition, ...]:
        """The key goes up, if it was down."""
        key = base_key(key)
        if self._held.pop(key, None) is None:
            return ()
        return (KeyTransition(key, False, self._clock()),)

    def clear(self) -> tuple[KeyTransition, ...]:
        """All keys up: on losing the focus, on leaving the screen. Whoever releases them then, we shall not hear."""
        now = self._clock()
        up = tuple(KeyTransition(key, False, now) for key in self._held)
        self._held.clear()
        return up
