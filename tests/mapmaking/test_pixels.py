"""Strokes are joined over short breaks, however many there are; doors and corners stay as they are."""

from __future__ import annotations

import numpy as np
import pytest

from kit.arrays import BoolArray
from kit.mapmaking.pixels import bridged
from kit.world.connected_parts import connected_parts

PEN, GAP, ALONG = 8, 15, 21


def stroke(*pieces: tuple[int, int]) -> BoolArray:
    """A wall across the sheet, and a stroke down from it in pieces, each from one row to another."""
    mask = np.zeros((240, 160), dtype=np.bool_)
    mask[20 : 20 + PEN] = True
    for top, bottom in pieces:
        mask[top:bottom, 80 : 80 + PEN] = True
    return mask


@pytest.mark.parametrize(
    "pieces",
    [
        ((20, 120), (130, 142), (152, 160)),
        ((20, 36), (46, 60), (70, 200)),
        ((20, 30), (40, 52), (62, 74), (84, 200)),
    ],
    ids=["at the end", "at a wall", "three breaks"],
)
def test_pieces_between_breaks_are_joined(pieces: tuple[tuple[int, int], ...]) -> None:
    joined = bridged(stroke(*pieces), GAP, ALONG)
    assert connected_parts(joined).max() == 1
    assert joined[20 : pieces[-1][1], 80 + PEN // 2].all()


def test_a_door_stays_open() -> None:
    mask = stroke((20, 100), (100 + 2 * GAP, 200))
    assert connected_parts(bridged(mask, GAP, ALONG)).max() == 2


def test_only_breaks_are_filled() -> None:
    mask = stroke((20, 200))
    mask[60:64, 80:82] = False  # a notch
    assert (bridged(mask, GAP, ALONG) == mask).all()
