"""What an agent sees, as numbers: sectors, sizes, bounds."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from kit.fields.adjacency import SIDE_RAYS
from kit.learning.maps.ray_directions import AHEAD_RAY, RAY_COUNT
from kit.learning.tasks.observations import ObservationSpec
from tests.cases import every_case
from tests.learning.worlds import NINE_NUMBERS, NINETEEN_NUMBERS, SEVENTEEN_NUMBERS

every_one = pytest.mark.parametrize("seen", [NINE_NUMBERS, SEVENTEEN_NUMBERS, NINETEEN_NUMBERS])


def degrees(ray: int) -> float:
    """From straight ahead, to the left positive."""
    return (ray - AHEAD_RAY) * 4.0


def test_the_dissertations_rays() -> None:
    assert [degrees(ray) for ray in SEVENTEEN_NUMBERS.rays] == [0, 8, -8, 92, -92]
    assert [[degrees(ray) for ray in side] for side in SIDE_RAYS] == [[-84, -100], [84, 100]]
    assert (NINE_NUMBERS.size, SEVENTEEN_NUMBERS.size, NINETEEN_NUMBERS.size) == (9, 17, 19)


def test_nine_sectors_of_ten_rays_the_last_of_eleven() -> None:
    _, stretches = NINE_NUMBERS.ray_tables(1)
    assert [(end - first) for _, first, end in stretches.tolist()] == [10] * 8 + [11]


def test_twelve_sectors_narrow_ahead_and_wide_behind() -> None:
    sizes = np.bincount(SEVENTEEN_NUMBERS.sectors)
    assert sizes.tolist() == [16, 15, *[5] * 9, 15]
    ahead = [degrees(ray) for ray in range(RAY_COUNT) if SEVENTEEN_NUMBERS.sectors[ray] == 6]
    assert ahead == [-8, -4, 0, 4, 8]
    assert {SEVENTEEN_NUMBERS.sectors[0], SEVENTEEN_NUMBERS.sectors[RAY_COUNT - 1]} == {0}


@every_one
def test_stretches_are_the_sectors(seen: ObservationSpec) -> None:
    single, stretches = seen.ray_tables(2)
    again = np.full(RAY_COUNT, -1)
    for sector, first, end in stretches.tolist():
        assert (again[first:end] == -1).all()
        again[first:end] = sector
    assert again.tolist() == list(seen.sectors)
    assert single.shape == (2, len(seen.rays) + 2 * seen.side_rays)


@every_one
@every_case("robots", [1, 2])
@every_case("target", [False, True])
@every_case("arrived", [False, True])
def test_the_space_has_a_bound_for_every_number(
    seen: ObservationSpec, robots: int, target: bool, arrived: bool
) -> None:
    more = replace(seen, target=target, arrived=arrived)
    space = more.space(robots)
    assert more.size == seen.size + 2 * target + arrived
    assert space.shape == (robots * more.size,)
    high, low = space.high.reshape(robots, -1), space.low.reshape(robots, -1)
    assert (high[:, : seen.size] == seen.clip * seen.scale).all()
    assert (low < 0).sum() == robots * target
    if arrived:
        assert (high[:, -1] == 1).all()
