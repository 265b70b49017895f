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
LEAST_LANE_WIDTH: Final = 2
"""Characters kept for them where a name would else be cut."""
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
    """The columns for a picture of this width: what lanes need beyond the usual is taken from the names. These have a third each,
    unless one is longer than that and another column has more than it needs.

    >>> from kit.render.graph_layout import LayoutSide
    >>> both = LayoutSide({"/flatland_server": 0}, {})
    >>> fit_columns(72, GraphLayout({"/scan": 0}, both, both)).node_width
    18
    """
    needed = [max(side.lanes.values(), default=-1) + 1 for side in (layout.senders, layout.receivers)]
    left, right = (max(least, lanes) for least, lanes in zip(MIN_LANE_WIDTHS, needed, strict=True))
    longest_node = _room_for(*layout.senders.rows, *layout.receivers.rows)
    longest_item = _room_for(*layout.items)
    free = width - RATE_WIDTH - 2 * ARROW_WIDTH - 2 * longest_node - longest_item
    right = min(right, max(LEAST_LANE_WIDTH, needed[1], free - left))
    left = min(left, max(LEAST_LANE_WIDTH, needed[0], free - right))
    names = max(3 * MIN_NAME_WIDTH, width - left - right - RATE_WIDTH - 2 * ARROW_WIDTH)
    nodes = names // 3
    spare = names - 2 * nodes - longest_item
    if spare > 0:
        nodes += max(0, min(longest_node - nodes, spare // 2))
    else:
        nodes -= max(0, min(nodes - longest_node, (1 - spare) // 2))
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


def _room_for(*names: str) -> int:
    """Characters of a column in which all these names are whole, each with its mark and a blank."""
    return max(map(len, names), default=0) + 2
