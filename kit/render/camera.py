"""The camera: maps world coordinates to dots, keeping metres square although characters are oblong."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from kit.arrays import FloatArray
from kit.render.scene import SceneBounds

CELL_ASPECT = 2.0
"""A terminal's character is about twice as high as it is wide."""

ZOOM_STEP = math.sqrt(2.0)
"""Two steps of zoom double the scale."""

MIN_CELL_WIDTH, MAX_CELL_WIDTH = 0.002, 20.0
"""The limits of zoom: the width of a character [m]."""

FIT_MARGIN = 0.45
"""Characters to spare around what is fitted in. Not one half, which would put the outermost walls between two
dots, on one side of them here and on the other there."""

FOLLOW_DEAD_ZONE = 0.5
"""The middle share of the picture in which a followed robot moves without the picture moving."""

FOLLOW_STEPS = 50
"""So many steps lead across the picture: a large one moves by several characters at a time, since to draw it shifted by
four costs little more than to draw it shifted by one."""


@dataclass(frozen=True, slots=True)
class Camera:
    """A window of ``columns`` x ``rows`` characters on the world, centred on ``(x, y)`` [m]."""

    x: float
    y: float
    cell_width: float
    """Width of a character [m]."""
    columns: int
    rows: int
    aspect: float = CELL_ASPECT
    """Height of a character divided by its width; 1 for pixels."""

    @classmethod
    def fit(
        cls,
        bounds: SceneBounds,
        columns: int,
        rows: int,
        aspect: float = CELL_ASPECT,
        margin: float = FIT_MARGIN,
    ) -> Camera:
        """The camera that shows all of ``bounds``, as large as it can, with ``margin`` characters to spare on
        every side."""
        columns, rows = max(1, columns), max(1, rows)
        across, up = max(0.5, columns - 2 * margin), max(0.5, rows - 2 * margin)
        cell = max(bounds.width / across, bounds.height / (up * aspect))
        return cls(
            (bounds.left + bounds.right) / 2,
            (bounds.bottom + bounds.top) / 2,
            max(cell, MIN_CELL_WIDTH),
            columns,
            rows,
            aspect,
        )

    @property
    def cell_height(self) -> float:
        """Height of a character [m]."""
        return self.cell_width * self.aspect

    @property
    def bounds(self) -> SceneBounds:
        """Returns the visible rectangle of the world."""
        across, up = self.columns * self.cell_width / 2, self.rows * self.cell_height / 2
        return SceneBounds(self.x - across, self.y - up, self.x + across, self.y + up)

    def resized(self, columns: int, rows: int) -> Camera:
        """A camera that shows the same place at the same scale in another window."""
        return replace(self, columns=max(1, columns), rows=max(1, rows))

    def zoomed(self, steps: int) -> Camera:
        """``steps`` nearer, or farther if negative; the centre stays."""
        cell = self.cell_width / ZOOM_STEP**steps
        return replace(self, cell_width=min(max(cell, MIN_CELL_WIDTH), MAX_CELL_WIDTH))

    def panned(self, columns: int, rows: int) -> Camera:
        """Moved by whole characters, to the right and up, so that what stands still keeps its shape."""
        return replace(self, x=self.x + columns * self.cell_width, y=self.y + rows * self.cell_height)

    def following(self, x: float, y: float) -> Camera:
        """Moved by as few steps as keep the point within the calm middle of the picture. A step is a whole number of
        characters, and of the same length [m] in both directions."""
        if not (math.isfinite(x) and math.isfinite(y)):
            return self
        across = max(1, self.columns // FOLLOW_STEPS)
        down = max(1, round(across / self.aspect))
        right = _back_into((x - self.x) / self.cell_width, self.columns * FOLLOW_DEAD_ZONE / 2, across)
        up = _back_into((y - self.y) / self.cell_height, self.rows * FOLLOW_DEAD_ZONE / 2, down)
        return self.panned(right, up) if right or up else self

    def project(self, points: FloatArray, across: int = 1, down: int = 1) -> FloatArray:
        """World points (..., 2) [m] as dot coordinates (..., 2): to the right and down from the upper left
        corner, ``across`` x ``down`` dots in a character. Dot (i, j) covers [i, i + 1) x [j, j + 1).
        """
        left, _, _, top = self.bounds
        scale = np.array((across / self.cell_width, -down / self.cell_height))
        dots: FloatArray = (points - np.array((left, top))) * scale
        return dots


def _back_into(offset: float, limit: float, step: int) -> int:
    """Returns the least multiple of ``step`` that brings ``offset`` back into [-limit, limit]."""
    steps = math.ceil(max(0.0, abs(offset) - limit) / step)
    return math.trunc(math.copysign(steps * step, offset))
