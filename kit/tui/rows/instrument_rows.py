"""The instruments of a large terminal beside a driven world: charts of lasers and speeds, the program."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING, Final

from kit.document.rows import Row, fitted, row, row_text, side_by_side
from kit.tui.rows.chart_rows import CHART_ROWS, laser_chart, time_chart
from kit.tui.rows.readout_rows import PANEL_WIDTH, message_rows
from kit.tui.rows.ruled_title import ruled_title

if TYPE_CHECKING:
    from kit.run.view import View


LARGE_SIZE: Final = (120, 36)
"""Columns and rows from which on a screen has room for instruments, whatever the picture needs."""
LEAST_ROWS: Final = 28
"""Rows from which on it has room for them where the picture leaves them the columns."""
LARGE_PANEL_WIDTH: Final = 46
WIDE_PANEL: Final = (160, 60)
"""From this many columns on, the panel is this wide."""
MARGIN: Final = 2
"""Columns of a panel that stay empty, at its sides."""
COLUMN_GAP: Final = 2
"""Empty columns between the two of a panel, which has two where the picture leaves it room for them."""
CARD_WIDTH, CODE_WIDTH = 60, 92
"""Columns that a card and a program's code have a use for."""
ENOUGH: Final = 0.75
"""The share of them with which they stand beside the instruments."""
TWO_COLUMNS: Final = 40
"""Columns of a panel from which on its figures stand in two columns."""
BY_WORTH: Final = ("speed", "drive", "nearest", "key mode (z)", "pose")
"""Titles of blocks of figures, the one that is left out last before the others."""
CHARTS: Final = 3
HIGHEST_CHART: Final = 10
"""Rows of a chart below which nothing else stands."""
MESSAGES: Final = "messages"
"""The title of the newest messages."""
MOST_MESSAGES: Final = 8
WINDOWS_S: Final = (10.0, 20.0, 60.0)
"""Seconds of the simulation that the charts of the past cover: the fewest that hold all of it, else the last minute."""
SAMPLE_S: Final = 0.2
"""Seconds between two of their points."""
MOST_SAMPLES: Final = round(WINDOWS_S[-1] / SAMPLE_S)


@dataclass(frozen=True)
class PanelWidths:
    """The columns of a panel: of the instruments, and of what stands beside them; 0 where that stands below them."""

    instruments: int = 0
    beside: int = 0
    plain: int = PANEL_WIDTH
    """Of a panel without instruments, with its margin."""

    @property
    def total(self) -> int:
        return self.instruments + (self.beside + COLUMN_GAP if self.beside else 0)

    @property
    def card(self) -> int:
        """Of what the panel has besides the instruments."""
        return self.beside or self.instruments


def _spare_columns(columns: int, rows: int, shape: float) -> int:
    """What a picture of a world of this shape leaves of a screen; 0 where nothing is known of it."""
    if math.isinf(shape):
        return 0
    from kit.render.camera import CELL_ASPECT  # numpy, which the first frame does not wait for

    return int(columns - CELL_ASPECT * rows * shape) - MARGIN


def plain_width(columns: int, rows: int, shape: float) -> int:
    """How wide a panel without instruments is that has a card. ``rows``: of the picture; ``shape``: as of ``panel_widths``."""
    return max(PANEL_WIDTH, min(LARGE_PANEL_WIDTH, _spare_columns(columns, rows, shape)))


def panel_widths(columns: int, rows: int, shape: float, wanted: int = 0) -> PanelWidths:
    """How wide the panel is on a screen of this size; nothing where there is no room for instruments.

    ``shape``: the width of the picture's world divided by its height; infinite where nothing is known of it. ``wanted``: the
    columns for which there is a use beside the instruments.
    """
    if rows < LEAST_ROWS:
        return PanelWidths()
    spare = _spare_columns(columns, rows, shape)
    beside = min(wanted, spare - LARGE_PANEL_WIDTH - COLUMN_GAP)
    if wanted and beside >= ENOUGH * wanted:
        return PanelWidths(min(WIDE_PANEL[1] - MARGIN, spare - COLUMN_GAP - beside), beside)
    width = min(spare, max(WIDE_PANEL[1] - MARGIN, wanted))
    if columns >= LARGE_SIZE[0] and rows >= LARGE_SIZE[1]:
        least = WIDE_PANEL[1] if columns >= WIDE_PANEL[0] else LARGE_PANEL_WIDTH
        return PanelWidths(max(least - MARGIN, width))
    return PanelWidths(width if width >= LARGE_PANEL_WIDTH - MARGIN else 0)


@dataclass
class SpeedHistory:
    """The robot's speeds of the last minute."""

    forward_speeds: deque[float] = field(default_factory=lambda: deque(maxlen=MOST_SAMPLES))
    turning: deque[float] = field(default_factory=lambda: deque(maxlen=MOST_SAMPLES))
    _last: float = -math.inf

    def add(self, view: View) -> None:
        """Notes the view's speeds, every ``SAMPLE_S``; starts again where the clock went back."""
        if view.time_s < self._last:
            self.forward_speeds.clear()
            self.turning.clear()
            self._last = -math.inf
        # Several samples at once where the simulation runs ahead of the screen: the chart's axis is time.
        missed = 1 if self._last == -math.inf else int((view.time_s - self._last) / SAMPLE_S + 1e-6)
        for _ in range(min(missed, self.forward_speeds.maxlen or 0)):
            self.forward_speeds.append(view.speed[0])
            self.turning.append(view.speed[1])
        if missed:
            self._last = view.time_s if self._last == -math.inf else self._last + missed * SAMPLE_S


@dataclass(frozen=True)
class Listing:
    """The code of the program that drives: the lines of its file, and what is said beside its name."""

    lines: Sequence[Row] = ()
    note: str = ""


def instruments(
    view: View,
    history: SpeedHistory,
    figures: Sequence[Row],
    program: Listing,
    card: Sequence[Row],
    widths: PanelWidths,
    height: int,
) -> tuple[Row, ...]:
    """The panel of a large screen, in order of importance as far as there is room; a chart for which there is none is left out
    whole.

    ``figures``: of ``figure_rows``. ``card``: what the screen tells besides; it and the program stand beside the charts where
    the panel has room for them there, else below.
    """
    if not widths.beside:
        width = widths.instruments
        above = _told(view, history, figures, (width, height - len(card)))
        below = _program_rows(view, program, width, height - len(card) - len(above))
        return (*above, *below, *card)[:height]
    left = _told(view, history, figures, (widths.instruments, height), HIGHEST_CHART)
    right = [*card, *_program_rows(view, program, widths.beside, height - len(card))]
    return tuple(side_by_side(left, right, widths.instruments + COLUMN_GAP)[:height])


def _told(
    view: View,
    history: SpeedHistory,
    figures: Sequence[Row],
    size: tuple[int, int],
    highest: int = CHART_ROWS,
) -> list[Row]:
    """Figures, charts of at most ``highest`` rows, and the newest messages."""
    width, height = size
    rows = with_charts(view, history, figures, size, highest)
    left = height - len(rows)
    if view.messages and left > 2:
        shown = view.messages[-max(1, min(len(view.messages), MOST_MESSAGES, left - 1)) :]
        rows += [
            ruled_title(MESSAGES, width),
            *(each for record in shown for each in message_rows(record, width)),
        ]
    return rows[:height]


def _program_rows(view: View, program: Listing, width: int, room: int) -> list[Row]:
    """The controller's code below its name."""
    if not program.lines or room <= 3:
        return []
    title = ruled_title(view.controller or "program", width, program.note)
    return [title, *_code_rows(program.lines, width, room - 1)]


def with_charts(
    view: View,
    history: SpeedHistory,
    figures: Sequence[Row],
    size: tuple[int, int],
    highest: int = CHART_ROWS,
) -> list[Row]:
    """The figures, and below them the charts for which ``size``, columns and rows, has room, of at most ``highest`` rows."""
    width, height = size
    rows = [*figures]
    messages = 1 + min(len(view.messages), MOST_MESSAGES) if view.messages else 0
    each_has = (height - len(rows) - messages) // CHARTS - 1
    high = min(highest, max(CHART_ROWS, each_has))
    for chart in _charts(view, history, width, high) if len(rows) + CHART_ROWS < height else ():
        if len(rows) + len(chart) <= height:
            rows += chart
    return rows


def tells_messages(panel: Sequence[Row]) -> bool:
    """Whether a panel of ``instruments`` has the newest messages."""
    title = ruled_title(MESSAGES, 2 * len(MESSAGES))[1]
    return any(title in each for each in panel)


def figure_rows(title: str, figures: Sequence[Row], width: int) -> list[Row]:
    """Figures in two columns below a title, with which the panel begins."""
    return [ruled_title(title, width), *_two_columns(figures, width)]


def figures_below(figures: Sequence[Row], width: int, room: int) -> list[Row]:
    """The blocks of figures for which there is room below a card, those that a driver needs first; in two columns where they
    are wide enough."""
    starts = _title_numbers(figures)
    blocks = [figures[start:end] for start, end in pairwise([*starts, len(figures)])]
    shown: list[Row] = []
    chosen: set[int] = set()
    for number in sorted(range(len(blocks)), key=lambda number: _worth(blocks[number])):
        rows = [each for at, block in enumerate(blocks) if at in chosen | {number} for each in block]
        laid = _two_columns(rows, width) if width >= TWO_COLUMNS else rows
        if len(laid) <= room:
            shown = laid
            chosen.add(number)
    return shown


def _worth(block: Sequence[Row]) -> int:
    """The place of a block of figures among those by worth."""
    title = row_text(block[0])
    return BY_WORTH.index(title) if title in BY_WORTH else len(BY_WORTH)


def _charts(view: View, history: SpeedHistory, width: int, rows: int) -> Iterator[list[Row]]:
    """What the laser sees, and the speeds of all the time that has passed, or of the last minute."""
    if view.nearest:  # it has a laser, whose first scan is to come or sees nothing
        ranges = view.laser.tolist()
        title = ruled_title("laser", width, "distance to the left, ahead, to the right")
        yield [title, *laser_chart(ranges, width, rows)]
    if history.forward_speeds:
        known_s = len(history.forward_speeds) * SAMPLE_S
        window_s = next((each for each in WINDOWS_S if each >= known_s), WINDOWS_S[-1])
        window = round(window_s / SAMPLE_S)
        title = ruled_title("speed", width, f"last {window_s:.0f} s, m/s")
        yield [title, *time_chart(history.forward_speeds, width, 0.1, window, rows)]
        title = ruled_title("turning", width, "rad/s, up is left")
        yield [title, *time_chart(history.turning, width, 0.5, window, rows)]


def _title_numbers(rows: Sequence[Row]) -> list[int]:
    """The numbers of the rows of figures with which a block begins."""
    return [
        number for number, parts in enumerate(rows) if len(parts) == 1 and not parts[0][0].startswith(" ")
    ]


def _two_columns(rows: Sequence[Row], width: int) -> list[Row]:
    """The rows in two columns; the second begins at a title."""
    titles = _title_numbers(rows)
    middle = min(titles, key=lambda number: abs(number - len(rows) / 2), default=0)
    left, right = rows[:middle], rows[middle:]
    half = width // 2
    joined = []
    for number in range(max(len(left), len(right))):
        first = left[number] if number < len(left) else ()
        used = sum(len(text) for text, _ in first)
        second = right[number] if number < len(right) else ()
        joined.append((*first, (" " * max(1, half - used), ""), *second))
    return joined


def _code_rows(program: Sequence[Row], width: int, rows: int) -> list[Row]:
    """The program from its first class or function on, or its beginning."""
    first = next(
        (number for number, line in enumerate(program) if row_text(line).startswith(("class ", "def "))), 0
    )
    start = max(0, min(first, len(program) - rows))
    return [
        fitted(row((f"{start + number + 1:3d} ", "dim"), *line), width)
        for number, line in enumerate(program[start : start + rows])
    ]
