"""What is wrong with a world file: where it stands, and words that help to mend it."""

from __future__ import annotations

import difflib
import unicodedata
from collections.abc import Collection, Iterable
from dataclasses import dataclass

from kit.world.records import Place

MAX_PROBLEMS = 100
"""More mistakes than this in one world are not collected: the first ones have to be mended anyway."""


@dataclass(frozen=True, slots=True, order=True)
class Problem:
    """One mistake: where it stands, and what is wrong, in words that help to mend it."""

    place: Place
    message: str

    def __str__(self) -> str:
        return f"{self.place}: {self.message}"


class WorldError(Exception):
    """A world, model or map that cannot be used; ``problems`` are sorted by file and line."""

    def __init__(self, problems: Iterable[Problem]) -> None:
        self.problems: tuple[Problem, ...] = tuple(sorted(set(problems)))
        super().__init__("\n".join(map(str, self.problems)))


class Problems:
    """What went wrong so far while reading. ``add`` raises WorldError once there are too many."""

    def __init__(self) -> None:
        self._found: set[Problem] = set()

    def add(self, place: Place, message: str) -> None:
        self._found.add(Problem(place, message))
        if len(self._found) >= MAX_PROBLEMS:
            self._found.add(Problem(place, f"{MAX_PROBLEMS} problems: no further ones are listed"))
            self.raise_if_any()

    def raise_if_any(self) -> None:
        if self._found:
            raise WorldError(self._found)

    def __bool__(self) -> bool:
        return bool(self._found)


def displayable(text: str) -> bool:
    """Whether a terminal would just show the text: spaces of any language, but no control characters."""
    return all(c.isprintable() or unicodedata.category(c) == "Zs" for c in text)


def quoted(text: str, limit: int = 60) -> str:
    """``text`` for a message: in quotes, cut to ``limit`` characters, nothing a terminal would obey."""
    shown = text if len(text) <= limit else text[: limit - 3] + "..."
    return '"' + "".join(c if displayable(c) else ascii(c)[1:-1] for c in shown) + '"'


def nearest(name: str, names: Iterable[str]) -> str | None:
    """The one of ``names`` that ``name`` was most likely meant to be, or None if none is close."""
    by_lower = {known.lower(): known for known in names}
    close = difflib.get_close_matches(name.lower(), by_lower, n=1, cutoff=0.6)
    return by_lower[close[0]] if close else None


def suggestion(name: str, names: Collection[str]) -> str:
    """The end of a message about a name that is not one of ``names``: what to write instead."""
    close = nearest(name, names)
    if close is not None:
        return f"did you mean {quoted(close)}?"
    if not names:
        return "there is none"
    listed = [quoted(known) for known in sorted(names)]
    return "known: " + ", ".join(listed[:12]) + (", ..." if len(listed) > 12 else "")
