"""Side by side, in every direction; both answers and the grade."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kit.fields.adjacency import adjacency_score, is_adjacent_by_poses, is_adjacent_by_rays
from kit.geometry import Pose
from tests.cases import every_case

turns = st.floats(-10, 10)


def pair(frame: Pose, right: Pose) -> tuple[Pose, Pose]:
    return frame, frame.compose(right)


@pytest.mark.long
@given(st.floats(-5, 5), st.floats(-5, 5), turns)
def test_abreast_is_abreast_wherever_they_face(x: float, y: float, theta: float) -> None:
    both = pair(Pose(x, y, theta), Pose(0, -0.3, 0))
    assert is_adjacent_by_poses(*both)
    assert adjacency_score(*both) == pytest.approx(1.0)


@pytest.mark.long
@given(
    turns,
    st.sampled_from(
        [Pose(0, 0.3, 0), Pose(0.3, 0, 0), Pose(-0.3, 0, 0), Pose(0, -0.3, math.pi), Pose(0, -0.6, 0)]
    ),
)
def test_swapped_behind_facing_away_or_far_is_not(theta: float, right: Pose) -> None:
    assert not is_adjacent_by_poses(*pair(Pose(1, 2, theta), right))


def test_headings_wrap_round() -> None:
    """3.1 and -3.1 rad are 0.08 rad apart; equation 4.4 as printed makes them 6.2."""
    assert is_adjacent_by_poses((0, 0, 3.1), (0, 0.3, -3.1))


def test_one_above_the_other_is_no_division_by_zero() -> None:
    """Facing along x with the partner straight below: equation 4.5 as printed divides by 0."""
    assert is_adjacent_by_poses((0, 0, 0), (0, -0.3, 0))
    assert not is_adjacent_by_poses((0, -0.3, 0), (0, 0, 0))  # nor does it confuse left and right


def test_the_grade_falls_smoothly() -> None:
    ahead = [float(adjacency_score((0, 0, 0), (d, -0.3, 0))) for d in (0, 0.04, 0.08, 0.2)]
    assert ahead == sorted(ahead, reverse=True)
    assert ahead[2] == pytest.approx(math.exp(-1))
    assert (
        adjacency_score((0, 0, 0), (0, -0.3, 0.0))
        > adjacency_score((0, 0, 0), (0, -0.3, 0.2))
        > adjacency_score((0, 0, 0), (0, -0.3, 1.0))
    )


@every_case(
    ("left", "right", "beside"),
    [
        ((0.22, 0.24), (0.22, 0.24), True),
        ((0.22, 0.24), (0.26, 0.20), True),
        ((0.22, 0.24), (0.28, 0.24), False),
        ((0.22, 0.41), (0.22, 0.41), False),
        ((0.22, math.nan), (0.22, 0.2), False),  # nothing within the laser's range
    ],
)
def test_four_rays(left: tuple[float, float], right: tuple[float, float], beside: bool) -> None:
    assert bool(is_adjacent_by_rays(left, right)) is beside


def test_two_walls_at_one_distance_fool_the_rays_and_not_the_geometry() -> None:
    assert is_adjacent_by_rays((0.3, 0.3), (0.3, 0.3))
    assert not is_adjacent_by_poses((0, 0, 0), (5, 0, 0))


def test_many_at_once() -> None:
    poses = np.zeros((4, 2, 3))
    poses[:, 1, 1] = -0.3
    assert is_adjacent_by_poses(poses[:, 0], poses[:, 1]).shape == (4,)
    assert adjacency_score(poses[:, 0], poses[:, 1]) == pytest.approx(np.ones(4))
    assert is_adjacent_by_rays(np.zeros((3, 2, 2)), np.zeros((3, 2, 2))).shape == (3, 2)
