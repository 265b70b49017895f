"""Forces against values computed by hand, and the laws they follow."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kit.fields.charges import ChargeField, CompositeCharge, Handover, LineCharge, PointCharge, TensionPoint
from tests.cases import every_case

SQRT3 = math.sqrt(3)
CORNER = (LineCharge(0, -2, 0, 0, -1), LineCharge(0, 0, 3, 0, -1))
"""Two walls that meet in a corner which stands out to the upper left."""
ELBOW = CompositeCharge(CORNER, (PointCharge(0, 0, -1),))


def near(x: float, y: float) -> object:
    return pytest.approx([x, y], abs=1e-9)


@every_case(
    ("charge", "point", "force"),
    [
        (PointCharge(0, 0, 1), (2, 0), (-0.25, 0)),  # attracts: 1 / 2^2
        (PointCharge(0, 0, -1), (2, 0), (0.25, 0)),  # repels
        (PointCharge(1, 1, 15), (4, 5), (-0.36, -0.48)),  # 15 / 25, along (-3, -4) / 5
        (PointCharge(3, 4, 1), (3, 4), (0, 0)),  # at the charge itself: no direction is right
        (LineCharge(0, 0, 1, 0, -1), (0.5, 0.5), (0, 4)),  # 1 / 0.5^2
        (LineCharge(0, 0, 1, 0, -1), (0.5, -0.5), (0, -4)),  # both sides
        (LineCharge(0, 0, 1, 0, -1), (1, 2), (0, 0.25)),  # at the very end of the strip
        (LineCharge(0, 0, 1, 0, -1), (1.001, 2), (0, 0)),  # beyond it
        (LineCharge(0, 0, 1, 0, -1), (0.5, 0), (0, 0)),  # on the line
        (LineCharge(0, 0, SQRT3, 1, -1), (SQRT3 / 2 - 0.5, 0.5 + SQRT3 / 2), (-0.5, SQRT3 / 2)),  # 30 degrees
        (LineCharge(0, 0, SQRT3, 1, -1), (-0.5, 0.0), (0, 0)),  # its foot would lie before the start
        (ELBOW, (-0.5, -1), (-4, 0)),  # the first line
        (ELBOW, (1, 0.5), (0, 4)),  # the second
        (ELBOW, (-3, 4), (-0.024, 0.032)),  # the corner: 1 / 25, along (-3, 4) / 5
        (ELBOW, (0.25, -0.5), (16, 0)),  # behind the corner both could: the nearer does
        (TensionPoint(1, 2, 100), (1, 1.5), (0, 50)),  # Hooke: 100 * 0.5
        (TensionPoint(1, 2, 100), (1, 2), (0, 0)),
    ],
)
def test_forces_by_hand(
    charge: PointCharge | LineCharge | CompositeCharge | TensionPoint,
    point: tuple[float, float],
    force: tuple[float, float],
) -> None:
    assert charge.force(point) == near(*force)


def test_of_a_composite_that_prefers_lines_the_first_acts_where_several_could() -> None:
    first_line = CompositeCharge(ELBOW.lines, ELBOW.points, Handover.FIRST_LINE)
    both = (1.0, -0.5)  # in both strips: 1 m from the first line, 0.5 m from the second
    assert ELBOW.force(both) == near(0, -4)
    assert first_line.force(both) == near(1, 0)
    for place in ((-0.5, -1), (1, 0.5), (-3, 4)):  # on the floor's side they are the same
        assert first_line.force(place) == pytest.approx(ELBOW.force(place))


def test_where_a_composite_hands_over_the_force_does_not_jump() -> None:
    turns = np.linspace(0.4, 1.5 * math.pi - 0.4, 4001)
    forces = ELBOW.force(np.column_stack((np.cos(turns), np.sin(turns))))
    assert np.hypot(*np.diff(forces, axis=0).T).max() < 0.05
    assert np.hypot(*forces.T).min() == pytest.approx(1.0)  # the corner's own, 1 m away


def test_where_lines_stay_apart_there_is_a_gap_that_the_corner_fills() -> None:
    gap = (-1, 1)
    assert ChargeField.from_charges(CORNER).forces(gap) == near(0, 0)
    assert np.hypot(*ELBOW.force(gap)) == pytest.approx(0.5)


def test_merged_with_its_corners_a_line_pulls_the_same() -> None:
    """A closed composite is computed from its lines alone; one that is open, or whose corners differ, is not."""
    corners = (PointCharge(0, -2, -1), PointCharge(0, 0, -1), PointCharge(3, 0, -1))
    closed = CompositeCharge(CORNER, corners)
    apart = CompositeCharge(CORNER, (*corners, PointCharge(50, 50, -1)))
    assert len(ChargeField.from_charges([closed]).segments) == 2
    assert len(ChargeField.from_charges([apart]).segments) == 6
    places = np.random.default_rng(1).uniform(-4, 4, (500, 2))
    assert closed.force(places) == pytest.approx(apart.force(places), rel=1e-6, abs=1e-6)


def test_off_the_open_ends_of_a_composite_its_corner_acts() -> None:
    assert np.hypot(*ELBOW.force((4, -3))) == pytest.approx(1 / 25)


coordinates = st.floats(-5, 5)


@given(st.tuples(coordinates, coordinates), st.tuples(coordinates, coordinates), st.floats(-math.pi, math.pi))
def test_turning_charge_and_place_turns_the_force(
    end: tuple[float, float], place: tuple[float, float], turn: float
) -> None:
    cos, sin = math.cos(turn), math.sin(turn)
    matrix = np.array(((cos, -sin), (sin, cos)))
    charge = CompositeCharge((LineCharge(0, 0, *end, -1),), (PointCharge(0, 0, -1), PointCharge(*end, -1)))
    x, y = matrix @ end
    turned = CompositeCharge((LineCharge(0, 0, x, y, -1),), (PointCharge(0, 0, -1), PointCharge(x, y, -1)))
    force = charge.force(place)
    same = turned.force(matrix @ place)
    if max(np.hypot(*force), np.hypot(*same)) < 1e4:  # else rounding decides, or it is on the line itself
        assert same == pytest.approx(matrix @ force, rel=1e-6, abs=1e-6)


@given(st.lists(st.tuples(coordinates, coordinates, st.floats(-3, 3)), max_size=5))
def test_charges_add_up(charges: list[tuple[float, float, float]]) -> None:
    points = [PointCharge(*charge) for charge in charges]
    places = np.array([(0.31, 0.77), (-2.2, 1.1)])
    alone = sum((point.force(places) for point in points), np.zeros((2, 2)))
    assert ChargeField.from_charges(points).forces(places) == pytest.approx(alone, rel=1e-9, abs=1e-9)


def test_any_shape_of_places_gives_that_shape_of_forces() -> None:
    field = ChargeField.from_charges([ELBOW, *CORNER])
    grid = np.random.default_rng(0).uniform(-3, 3, (37, 41, 2))  # more than one block
    forces = field.forces(grid)
    assert forces.shape == grid.shape
    assert forces[30, 7] == pytest.approx(field.forces(grid[30, 7]))
    assert ChargeField.from_charges([]).forces(grid) == pytest.approx(np.zeros(grid.shape))


def test_a_push_grows_towards_the_wall() -> None:
    strengths = np.hypot(*CORNER[0].force([(-d, -1) for d in (1.0, 0.5, 0.1, 0.01)]).T)
    assert all(after > before for before, after in pairwise(strengths))
    assert strengths[-1] == pytest.approx(1e4)
