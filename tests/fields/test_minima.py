"""Traps where they must be, and none where none is."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kit.fields.charges import ChargeField, LineCharge
from kit.fields.controller_setup import ControllerSetup, mean_position
from kit.fields.layout import ChargeLayout, Intensities
from kit.fields.minima import ForceFlow
from kit.fields.occupancy_grid import OccupancyGrid
from kit.run.scenario import find_scenario

ROOM = [(-2, -2, 2, -2), (2, -2, 2, 4), (2, 4, -2, 4), (-2, 4, -2, -2)]


def test_a_trap_where_pull_and_push_are_equal_by_hand() -> None:
    """A target of 4 at (0, 2) behind a line along y = 1: 4 / (2 - y)^2 = 1 / (1 - y)^2 at y = 0."""
    grid = OccupancyGrid.from_walls(np.array(ROOM, dtype=float), [(0.0, 0.0)])
    charges = (LineCharge(-1.9, 1, 1.9, 1),)
    flow = ForceFlow.from_layout(
        ChargeLayout(charges, Intensities(target=4), None, ChargeField.from_charges(charges)),
        grid,
        (0.0, 2.0),
    )
    (trap,) = flow.traps(least=0.2)
    assert trap[:2] == pytest.approx((0, 0), abs=0.06)
    assert not flow.reaches(0.5, -1.0)
    assert flow.reaches(0.5, 3.0)
    assert flow.end(0.5, -1.0) == pytest.approx((0, 0), abs=0.15)


def test_a_target_alone_has_no_trap() -> None:
    grid = OccupancyGrid.from_walls(np.array(ROOM, dtype=float), [(0.0, 0.0)])
    flow = ForceFlow.from_layout(
        ChargeLayout((), Intensities(), None, ChargeField.from_charges(())), grid, (0.5, 2.0)
    )
    assert flow.traps() == ()
    assert flow.reaches(-1.5, -1.5)
    assert flow.end(5, 5) is None


@pytest.mark.parametrize(
    "name", ["pair_straight", "pair_turn_90", "pair_turn_180", "pair_curve_90", "pair_curve_180"]
)
def test_the_hallways_that_turn_right_round_are_traps_and_the_others_not(name: str) -> None:
    for case in ("left", "right") if name != "pair_straight" else ("",):
        whole = name.replace("_90", f"_{case}_90").replace("_180", f"_{case}_180")
        place = find_scenario(name, whole)
        assert place.case is not None
        setup = ControllerSetup.load(
            place.world.file, place.partners, place.case.target, place.case.target_radius
        )
        reaches = setup.flow.reaches(*mean_position(place.starts))
        assert reaches is ("180" not in name)
        assert bool(setup.flow.traps()) is ("180" in name)


def test_the_navigation_function_leads_from_everywhere_to_the_target() -> None:
    place = find_scenario("pair_turn_180")
    assert place.case is not None
    setup = ControllerSetup.load(place.world.file, ["left"], place.case.target)
    ways = setup.cost_to_go((0.63, 0.5))
    flow = ForceFlow.from_forces(ways.directions(), setup.grid, place.case.target)
    reachable = np.argwhere(np.isfinite(ways.cost))
    ends = [flow.end(*setup.grid.cell_center((int(row), int(column)))) for row, column in reachable[::37]]
    assert all(end is not None and math.dist(end, place.case.target) < 0.3 for end in ends)
