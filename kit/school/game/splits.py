"""Splits of a drive: when it passed the same places as another drive, and how much sooner or later."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from kit.school.game.ghosts import Ghost

SECTORS: Final = 3
"""Into so many parts of equal length a drive is divided."""
NEAR: Final = 0.8
"""A place counts as passed within this distance of it [m]."""


@dataclass(frozen=True, slots=True)
class Split:
    """One sector of a drive."""

    time: float
    """When its end was passed [s]."""
    sector: float
    """Time from the end of the sector before [s]."""
    difference: float
    """How much longer the sector took than it took the other drive [s]; negative: shorter."""


class GhostComparison:
    """Compares a drive, pose by pose, with a ghost: where the ghost was when it stood at the same place."""

    def __init__(self, ghost: Ghost) -> None:
        track = ghost.tracks[0][:, :2] if ghost.tracks else np.zeros((0, 2))
        self._ghost = ghost
        self._track: NDArray[np.float64] = track[np.isfinite(track).all(axis=1)]
        self._at = 0
        self._window = max(1, round(1.5 / ghost.step_size))
        along = (
            np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(self._track, axis=0).T))])
            if len(track)
            else track
        )
        ends = [along[-1] * number / SECTORS for number in range(1, SECTORS)] if len(track) else []
        self._ends = [int(np.searchsorted(along, end)) for end in ends]
        self._passed: list[tuple[float, float]] = []

    def add(self, time_s: float, x: float, y: float) -> float | None:
        """The time [s] by which the drive is behind the ghost at this place, negative if ahead; None away from its way."""
        window = self._track[self._at : self._at + self._window]
        if not len(window):
            return None
        distances = np.hypot(window[:, 0] - x, window[:, 1] - y)
        nearest = int(distances.argmin())
        if distances[nearest] > NEAR:
            return None
        self._at += nearest
        while len(self._passed) < len(self._ends) and self._at >= self._ends[len(self._passed)]:
            self._passed.append((time_s, self._ends[len(self._passed)] * self._ghost.step_size))
        return time_s - self._at * self._ghost.step_size

    def splits(self, finish_s: float) -> tuple[Split, ...]:
        """All sectors of a drive that has ended; none where its way was another."""
        if len(self._passed) < len(self._ends) or not self._ends:
            return ()
        times = [*self._passed, (finish_s, self._ghost.seconds)]
        before = (0.0, 0.0)
        found = []
        for mine, theirs in times:
            sector = mine - before[0]
            found.append(Split(mine, sector, sector - (theirs - before[1])))
            before = mine, theirs
        return tuple(found)


def compare_tracks(
    track: NDArray[np.float64], step_size: float, ghost: Ghost, finish_s: float
) -> tuple[Split, ...]:
    """The splits of a whole recorded drive, ``track`` (ticks, 3), against a ghost."""
    comparison = GhostComparison(ghost)
    for tick in range(0, len(track), 5):
        comparison.add(tick * step_size, float(track[tick, 0]), float(track[tick, 1]))
    return comparison.splits(finish_s)
