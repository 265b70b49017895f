"""Mistakes in world files: their location and a message that helps to fix them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from kit.world.records import SourceLocation

MAX_PROBLEMS = 100
"""More mistakes than this in one world are not collected: the first ones have to be fixed anyway."""


@dataclass(frozen=True, slots=True, order=True)
class Problem:
    """One mistake: its location, and a message that helps to fix it."""

    location: SourceLocation
    message: str

    def __str__(self) -> str:
        return f"{self.location}: {self.message}"


class WorldError(Exception):
    """A world, model or map that cannot be used; ``problems`` are sorted by file and line."""

    def __init__(self, problems: Iterable[Problem]) -> None:
        self.problems: tuple[Problem, ...] = tuple(sorted(set(problems)))
        super().__init__("\n".join(map(str, self.problems)))


class ProblemCollector:
    """Collects mistakes while reading. ``add`` raises WorldError once there are too many."""

    def __init__(self) -> None:
        self._found: set[Problem] = set()

    def add(self, location: SourceLocation, message: str) -> None:
        self._found.add(Problem(location, message))
        if len(self._found) >= MAX_PROBLEMS:
            self._found.add(Problem(location, f"{MAX_PROBLEMS} problems; more are not listed"))
            self.raise_if_any()

    def raise_if_any(self) -> None:
        if self._found:
            raise self.error()

    def error(self) -> WorldError:
        """The error that tells all mistakes collected so far."""
        return WorldError(self._found)

    def __len__(self) -> int:
        return len(self._found)
