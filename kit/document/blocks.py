"""What the kit tells a person, independent of where it is shown: a document is a sequence of blocks.

A block is a paragraph, marked text, a line of code, choices, a picture, a table, a plot or a quote. ``layout.py`` places
blocks in rows of a width, which a screen shows with their tones and which are printed without them; ``files.py`` writes them
as Markdown, CSV, JSON, HTML and SVG.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from kit.render.scene import Scene  # numpy, which few pages need

Interval = tuple[float, float]
"""The lower and the upper bound of a value; a ``ConfidenceInterval`` is one."""


class Tone(StrEnum):
    """What a piece of text means. A screen shows tones by weight and colour; none means anything by its colour alone."""

    PLAIN = ""
    DIM = "dim"
    BOLD = "bold"
    GOOD = "good"
    WARN = "warn"
    BAD = "bad"
    CODE = "code"
    KEY = "press"
    """A key to press."""
    BRONZE = "bronze"
    """The letter of that medal; the others have tones of their weight."""
    TITLE = "title"
    """The name of a screen or of a part of it."""
    CHOSEN = "chosen"
    """The selected entry of a list."""


@dataclass(frozen=True, slots=True)
class ToneText:
    """A cell of a table in a tone of its own."""

    text: str
    tone: Tone

    def __str__(self) -> str:
        return self.text


Cell = str | int | float | Interval | ToneText | None
"""None and NaN: there is no value."""


@dataclass(frozen=True, slots=True)
class Text:
    """A paragraph, or one for each line of ``text``."""

    text: str
    tone: Tone = Tone.PLAIN
    lead: str = ""
    """Words before it, in a tone of their own: ``Right.``"""
    lead_tone: Tone = Tone.BOLD
    tail: str = ""
    """Follows the last word, is never parted from it, and is dim: `` 2 of 4``."""
    indent: int = 0
    """Columns before the first line."""
    hang: int = 0
    """Columns by which the lines after the first begin further to the right."""
    is_tight: bool = False
    """Whether it follows the block before it without an empty row."""

    @property
    def whole_text(self) -> str:
        """The text with its lead and its tail."""
        return f"{self.lead} {self.text}".strip() + self.tail


@dataclass(frozen=True, slots=True)
class Marked:
    """Text with the little markup of ``markup.py``: paragraphs, lists, `code`, **bold**, blocks of code."""

    text: str
    is_tight: bool = False


@dataclass(frozen=True, slots=True)
class Code:
    """Lines of code, or commands to type. One that is too long is broken where a shell or Python would let it be."""

    lines: tuple[str, ...]
    indent: int = 4
    is_tight: bool = False


@dataclass(frozen=True, slots=True)
class Picture:
    """Fixed characters, which are never wrapped."""

    lines: tuple[str, ...]
    indent: int = 2
    tone: Tone = Tone.PLAIN
    is_tight: bool = False
    is_diagram: bool = False
    """Whether its lines and arrows of ``-``, ``|``, ``+`` and ``>`` are joined where it is looked at."""

    @staticmethod
    def of_diagram(lines: Iterable[str], indent: int = 2) -> tuple[Picture, ...]:
        """A diagram as a block, or nothing where there are no lines."""
        drawn = tuple(lines)
        return (Picture(drawn, indent, is_diagram=True),) if drawn else ()


@dataclass(frozen=True, slots=True)
class Choice:
    """An entry that a key chooses."""

    key: str
    text: str
    tone: Tone = Tone.PLAIN
    mark: str = " "
    """One character in the margin: ``>`` chosen, ``+`` right, ``x`` wrong."""
    is_open: bool = True
    """Whether its key chooses it now."""


@dataclass(frozen=True, slots=True)
class Choices:
    """Entries one below the other."""

    entries: tuple[Choice, ...]
    is_tight: bool = False


@dataclass(frozen=True, slots=True)
class KeyLine:
    """A question with the keys that answer it, in one row where there is room: ``How sure are you?  1 guess  2 ...``"""

    text: str
    entries: tuple[Choice, ...]
    is_tight: bool = False


@dataclass(frozen=True, slots=True)
class RatingScale:
    """Numbers to choose from, in one row, and below them what the lowest and the highest mean."""

    points: tuple[int, ...]
    low: str
    high: str
    chosen: int | None = None
    """Index of the chosen one."""
    is_tight: bool = False


class CellStyle(StrEnum):
    """Format of the cells of a column."""

    TEXT = "text"
    NUMBER = "number"
    P_VALUE = "chance"
    """A p value: three decimals, or below 0.001."""


@dataclass(frozen=True, slots=True)
class Column:
    title: str
    style: CellStyle = CellStyle.NUMBER
    decimals: int = 2
    is_optional: bool = False
    """Whether it is left out where the table is wider than its room; the last of these first."""


@dataclass(frozen=True, slots=True)
class Table:
    id: str
    """Used in file names: letters, digits, hyphens."""
    title: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[Cell, ...], ...]
    note: str = ""
    """Shown below the table."""
    grouped: bool = False
    """Rows with the same first cell form a group: for readers it is shown once, in data formats on every row."""
    is_ruled: bool = True
    """Whether a line parts the heads from the rows."""
    indent: int = 0
    """Columns before its rows, below the title."""
    is_tight: bool = False

    def shows_first_cell(self, number: int) -> bool:
        """Whether the first cell of this row is shown to readers."""
        return not self.grouped or not number or self.rows[number][0] != self.rows[number - 1][0]


def labelled_table(
    rows: Iterable[tuple[Cell, ...]], title: str = "", *, indent: int = 0, is_tight: bool = False
) -> Table:
    """A table of texts without heads: names, and what is said of each."""
    cells = tuple(rows)
    columns = (Column("", CellStyle.TEXT),) * max(map(len, cells), default=1)
    return Table("", title, columns, cells, indent=indent, is_tight=is_tight)


@dataclass(frozen=True, slots=True)
class BarChart:
    """A bar chart with one bar per group in each row."""

    id: str
    title: str
    groups: tuple[str, ...]
    rows: tuple[tuple[str, tuple[float, ...]], ...]
    """Label, and a value per group; NaN: no bar."""
    low: float
    """The value at which bars begin."""
    high: float


@dataclass(frozen=True, slots=True)
class Histogram:
    id: str
    title: str
    edges: tuple[float, ...]
    """One more edge than counts. A value on an edge belongs to the bin above it; the last bin includes both edges."""
    counts: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class ScatterPlot:
    id: str
    title: str
    x: str
    """Label of the horizontal axis."""
    y: str
    points: tuple[tuple[float, float], ...]
    x_range: tuple[float, float]
    y_range: tuple[float, float]
    line: tuple[float, float] | None = None
    """Slope and intercept of the trend line."""


@dataclass(frozen=True, slots=True)
class Caution:
    """A warning that readers must not overlook."""

    text: str
    is_tight: bool = False


@dataclass(frozen=True, slots=True)
class Quote:
    """A student's answer in free text, unchanged."""

    student: str
    text: str


@dataclass(frozen=True, slots=True)
class ScenePlot:
    """A map with what happened on it."""

    id: str
    title: str
    scene: Scene


Plot = BarChart | Histogram | ScatterPlot | ScenePlot
Block = Text | Marked | Code | Picture | Choices | KeyLine | RatingScale | Table | Plot | Caution | Quote


@dataclass(frozen=True, slots=True)
class Chapter:
    id: str
    title: str
    blocks: tuple[Block, ...]


@dataclass(frozen=True, slots=True)
class Document:
    """Blocks under a title, in chapters."""

    title: str
    chapters: tuple[Chapter, ...]

    @property
    def tables(self) -> tuple[Table, ...]:
        return tuple(each for chapter in self.chapters for each in chapter.blocks if isinstance(each, Table))

    @property
    def plots(self) -> tuple[Plot, ...]:
        return tuple(each for chapter in self.chapters for each in chapter.blocks if isinstance(each, Plot))


def p_value_text(p: float) -> str:
    """A p value in a sentence."""
    return "p < 0.001" if p < 0.001 else f"p = {p:.3f}"


def format_cell(cell: Cell, column: Column) -> str:
    """The text of a cell for readers."""
    if isinstance(cell, tuple):
        low, high = cell
        return "-" if low != low else f"{low:.{column.decimals}f} to {high:.{column.decimals}f}"
    if cell is None or cell != cell:
        return "-"
    if isinstance(cell, float):
        if column.style is CellStyle.P_VALUE:
            return "< 0.001" if cell < 0.001 else f"{cell:.3f}"
        shown = f"{cell:.{column.decimals}f}"
        return shown.lstrip("-") if float(shown) == 0 else shown
    return str(cell)
