"""The columns of a graph drawing: how wide each is and where it begins."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from kit.render.graph_layout import GraphLayout

RATE_WIDTH: Final = 8
"""Characters for an item's rate."""
ARROW_WIDTH: Final = 2
MIN_LANE_WIDTHS: Final = (5, 8)
"""Characters kept for lanes, left and right, so that the columns stay where they are when one joins."""
MIN_NAME_WIDTH: Final = 8


@dataclass(frozen=True, slots=True)
class ColumnLayout:
    """Positions and widths of the columns."""

    width: int
    node_width: int
    """Width of each column of nodes."""
    left_gap: int
    """Between senders and items: lanes, then the rate, then the arrow."""
    item_width: int
    right_gap: int
    """Between items and receivers: lanes, then the arrow."""
    lane_pitch: tuple[int, int]
    """Characters from one lane to the next, left and right."""

    @property
    def item_start(self) -> int:
        """The first character of the items."""
        return self.node_width + self.left_gap

    @property
    def receiver_start(self) -> int:
        """The first character of the receivers."""
        return self.item_start + self.item_width + self.right_gap


def fit_columns(width: int, layout: GraphLayout) -> ColumnLayout:
    """The columns for a picture of this width: what lanes need beyond the usual is taken from the names."""
    needed = [max(side.lanes.values(), default=-1) + 1 for side in (layout.senders, layout.receivers)]
    left, right = (max(least, lanes) for least, lanes in zip(MIN_LANE_WIDTHS, needed, strict=True))
    names = max(3 * MIN_NAME_WIDTH, width - left - right - RATE_WIDTH - 2 * ARROW_WIDTH)
    nodes = names // 3
    pitches = tuple(
        2 if lanes and 2 * lanes <= room else 1 for lanes, room in zip(needed, (left, right), strict=True)
    )
    return ColumnLayout(
        width,
        nodes,
        left + RATE_WIDTH + ARROW_WIDTH,
        names - 2 * nodes,
        right + ARROW_WIDTH,
        (pitches[0], pitches[1]),
    )
