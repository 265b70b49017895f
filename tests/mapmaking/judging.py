"""Compares the walls that are found in a photograph with the true ones."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kit.arrays import BoolArray
from kit.mapmaking.photo import PhotoError, PhotoScale, plan_from_photo
from kit.mapmaking.pixels import dilated_along_rows
from tests.mapmaking.photos import SHEET, Photo, true_mask

TOLERANCE = 0.02
"""[m], at 5 m."""
SCALE = 200
"""Pixels per metre in which walls are compared."""


@dataclass(frozen=True, slots=True)
class Judgement:
    """What is wrong with the walls found in one photograph."""

    refusal: str
    """What the reader said where it found no walls; empty: it found some."""
    missing: int
    """Pixels of true walls farther than the tolerance from any wall found."""
    extra: int
    """Pixels of found walls farther than the tolerance from any true wall."""
    remarks: tuple[str, ...] = ()
    """What the reader doubts."""

    @property
    def is_right(self) -> bool:
        return not self.refusal and self.missing == self.extra == 0


def judge(photo: Photo) -> Judgement:
    """Reads a photograph and compares."""
    try:
        read = plan_from_photo(photo.image, PhotoScale(sheet_width=SHEET[0]))
    except PhotoError as error:
        return Judgement(str(error), 0, 0)
    truth, walls = true_mask(photo, SCALE), read.plan.walls
    rows, columns = min(truth.shape[0], walls.shape[0]), min(truth.shape[1], walls.shape[1])
    truth, walls = truth[:rows, :columns], walls[:rows, :columns]
    reach = round(TOLERANCE * SCALE)
    return Judgement(
        "",
        int((truth & ~spread(walls, reach)).sum()),
        int((walls & ~spread(truth, reach)).sum()),
        read.strokes.remarks,
    )


def spread(mask: BoolArray, reach: int) -> BoolArray:
    """Where the mask is true within ``reach`` pixels."""
    result = mask.copy()
    for down in range(-reach, reach + 1):
        across = int(np.sqrt(reach * reach - down * down))
        wide = dilated_along_rows(mask, 2 * across + 1)
        moved = np.zeros_like(wide)
        if down >= 0:
            moved[down:] = wide[: wide.shape[0] - down]
        else:
            moved[:down] = wide[-down:]
        result |= moved
    return result
