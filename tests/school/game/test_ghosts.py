"""A drive beside a ghost: how far behind it is at each place, also where the ghost comes by twice, and after a bump."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from kit.school.game.ghosts import Ghost, GhostComparison, compare_tracks

STEP = 0.01
OUT = np.arange(0.0, 2.0, 0.5 * STEP)
SIDEWAYS = np.repeat([0.0, 0.02], len(OUT))
THERE_AND_BACK = np.stack([np.concatenate([OUT, OUT[::-1]]), SIDEWAYS, np.zeros(2 * len(OUT))], axis=1)
"""2 m along x at 0.5 m/s and backwards home, a little to the left: 8 s."""
GHOST = Ghost("reference", len(THERE_AND_BACK) * STEP, (THERE_AND_BACK,), STEP)


def test_the_same_drive_is_never_behind_nor_ahead_also_beside_the_ghosts_way_back() -> None:
    comparison = GhostComparison(GHOST)
    along = THERE_AND_BACK[:, 0]
    behind = [comparison.update(tick * STEP, along[tick], 0.02) for tick in range(0, 800, 5)]
    assert behind == pytest.approx([0.0] * len(behind), abs=0.05)
    assert [each.difference for each in comparison.splits(GHOST.seconds)] == pytest.approx([0.0] * 3, abs=0.1)


def test_a_slow_drive_is_behind_by_more_and_more_and_each_sector_says_its_part() -> None:
    slow = np.repeat(THERE_AND_BACK, 2, axis=0)
    comparison = GhostComparison(GHOST)
    behind = [comparison.update(tick * STEP, *slow[tick, :2]) for tick in range(0, 1600, 5)]
    assert all(later >= earlier - 0.05 for earlier, later in pairwise(behind))  # type: ignore[operator]  # never None here
    assert behind[-1] == pytest.approx(8.0, abs=0.1)
    assert sum(each.difference for each in compare_tracks(slow, STEP, GHOST, 16.0)) == pytest.approx(8.0)


def test_who_is_put_back_to_the_start_begins_the_way_again() -> None:
    comparison = GhostComparison(GHOST)
    for tick in range(0, 600, 5):
        comparison.update(tick * STEP, *THERE_AND_BACK[tick, :2])
    assert comparison.update(6.0, 0.0, 0.0) == pytest.approx(6.0, abs=0.05)
    for tick in range(0, 800, 5):
        comparison.update(6.05 + tick * STEP, *THERE_AND_BACK[tick, :2])
    first, *others = comparison.splits(14.05)
    assert first.difference == pytest.approx(6.0, abs=0.2)
    assert [each.difference for each in others] == pytest.approx([0.0, 0.0], abs=0.1)


def test_away_from_the_ghosts_way_there_is_no_difference() -> None:
    comparison = GhostComparison(GHOST)
    assert comparison.update(1.0, 0.5, 1.5) is None
    assert comparison.splits(9.0) == ()
