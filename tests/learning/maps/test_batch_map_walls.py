"""Walls that no robot can ever see or meet are left out, and no others."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kit.arrays import FloatArray
from kit.learning.maps.wall_culling import cull_walls


def ring(*corners: tuple[float, float]) -> FloatArray:
    return np.array([[*one, *other] for one, other in zip(corners, corners[1:] + corners[:1], strict=True)])


def box(left: float, bottom: float, right: float, top: float) -> FloatArray:
    return ring((left, bottom), (right, bottom), (right, top), (left, top))


ROOM, OUTER, PILLAR = box(0, 0, 4, 4), box(-0.1, -0.1, 4.1, 4.1), box(1, 1, 1.5, 1.5)
LINE = np.array([[3.0, 1.0, 3.0, 2.0]])


def kept(*parts: FloatArray, point: tuple[float, float] = (2.0, 2.0)) -> set[tuple[float, ...]]:
    return set(map(tuple, cull_walls(np.concatenate(parts), point).tolist()))


def of(*parts: FloatArray) -> set[tuple[float, ...]]:
    return set(map(tuple, np.concatenate(parts).tolist()))


def test_outer_faces_are_left_out() -> None:
    assert kept(OUTER, ROOM, PILLAR, LINE) == of(ROOM, PILLAR, LINE)


def test_what_stands_in_the_room_stays_whatever_its_form() -> None:
    cross = np.array([[2.5, 2.5, 3.0, 3.0], [2.5, 3.0, 3.0, 2.5]])
    assert kept(ROOM, cross) == of(ROOM, cross)


def test_the_room_next_door_is_left_out() -> None:
    next_door = box(5, 0.5, 9, 3.5)
    assert kept(ROOM, next_door) == of(ROOM)
    assert kept(ROOM, next_door, point=(6.0, 2.0)) == of(next_door)


def test_a_wall_through_the_ring_stays() -> None:
    through = np.array([[-1.0, 2.0, 5.0, 2.0], [4.0, 3.0, 5.0, 3.0]])
    assert kept(ROOM, through) == of(ROOM, through)


def test_an_open_room_keeps_everything() -> None:
    assert kept(OUTER, ROOM[:3]) == of(OUTER, ROOM[:3])
    assert kept(OUTER[:2], ROOM[:3]) == of(OUTER[:2], ROOM[:3])


def test_no_walls() -> None:
    assert cull_walls(np.zeros((0, 4)), (0.0, 0.0)).shape == (0, 4)


@pytest.mark.parametrize("turn", [0.0, 0.3, 1.0])
def test_rings_may_stand_askew(turn: float) -> None:
    cos, sin = math.cos(turn), math.sin(turn)
    spin = np.array([[cos, sin], [-sin, cos]])
    parts = [(part.reshape(-1, 2) @ spin).reshape(-1, 4) for part in (OUTER, ROOM, PILLAR)]
    point = tuple((np.array([2.0, 2.0]) @ spin).tolist())
    assert kept(*parts, point=(point[0], point[1])) == of(*parts[1:])
