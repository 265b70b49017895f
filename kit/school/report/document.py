"""The records of a report, independent of the output format: chapters of tables, plots, texts and warnings."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from kit.learning.policies.confidence_intervals import ConfidenceInterval
from kit.render.scene import Scene

TableCell = str | int | float | ConfidenceInterval | None
"""None and NaN: there is no value."""


class CellStyle(StrEnum):
    """Format of the cells of a column."""

    TEXT = "text"
    NUMBER = "number"
    P_VALUE = "chance"
    """A p value: three decimals, or below 0.001."""


@dataclass(frozen=True, slots=True)
class TableColumn:
    title: str
    style: CellStyle = CellStyle.NUMBER
    decimals: int = 2


@dataclass(frozen=True, slots=True)
class ReportTable:
    id: str
    """Used in file names: letters, digits, hyphens."""
    title: str
    columns: tuple[TableColumn, ...]
    rows: tuple[tuple[TableCell, ...], ...]
    note: str = ""
    """Shown below the table."""
    grouped: bool = False
    """Rows with the same first cell form a group: for readers it is shown once, in data formats on every row."""

    def shows_first_cell(self, number: int) -> bool:
        """Whether the first cell of this row is shown to readers."""
        return not self.grouped or not number or self.rows[number][0] != self.rows[number - 1][0]


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
class ReportText:
    text: str


@dataclass(frozen=True, slots=True)
class ReportWarning:
    """A warning that readers must not overlook."""

    text: str


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


ReportPlot = BarChart | Histogram | ScatterPlot | ScenePlot
ReportBlock = ReportTable | ReportPlot | ReportText | ReportWarning | Quote


@dataclass(frozen=True, slots=True)
class ReportChapter:
    id: str
    title: str
    blocks: tuple[ReportBlock, ...]


@dataclass(frozen=True, slots=True)
class ClassReport:
    title: str
    chapters: tuple[ReportChapter, ...]

    @property
    def tables(self) -> tuple[ReportTable, ...]:
        return tuple(
            each for chapter in self.chapters for each in chapter.blocks if isinstance(each, ReportTable)
        )

    @property
    def plots(self) -> tuple[ReportPlot, ...]:
        return tuple(
            each for chapter in self.chapters for each in chapter.blocks if isinstance(each, ReportPlot)
        )


def p_value_text(p: float) -> str:
    """A p value in a sentence."""
    return "p < 0.001" if p < 0.001 else f"p = {p:.3f}"


def format_cell(cell: TableCell, column: TableColumn) -> str:
    """The text of a cell for readers."""
    if isinstance(cell, ConfidenceInterval):
        if cell.low != cell.low:
            return "-"
        return f"{cell.low:.{column.decimals}f} to {cell.high:.{column.decimals}f}"
    if cell is None or cell != cell:
        return "-"
    if isinstance(cell, float):
        if column.style is CellStyle.P_VALUE:
            return "< 0.001" if cell < 0.001 else f"{cell:.3f}"
        shown = f"{cell:.{column.decimals}f}"
        return shown.lstrip("-") if float(shown) == 0 else shown
    return str(cell)
