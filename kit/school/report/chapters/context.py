"""The context of all chapters (class data and division), and tables and bar charts of means by group."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

import numpy as np

from kit.arrays import FloatArray
from kit.document.blocks import BarChart, Caution, Cell, CellStyle, Column, Table
from kit.learning.policies.confidence_intervals import ConfidenceInterval
from kit.school.report.class_data import ClassData
from kit.school.report.expertise import MIN_GROUP_SIZE, ClassDivision
from kit.school.report.inference import PermutationTestResult, difference_test, summary_statistics
from kit.school.report.measures import StudentGroup, StudentMeasure
from kit.school.survey import SCALE_MAX, SCALE_MIN

SCALE_BOUNDS: Final = (float(SCALE_MIN), float(SCALE_MAX))
SHARE_BOUNDS: Final = (0.0, 1.0)

TOPIC_TITLES: Final[Mapping[str, str]] = MappingProxyType(
    {
        "robotics": "Robotics",
        "ros1": "ROS 1",
        "ros2": "ROS 2",
        "simulators": "Robot simulators",
        "flatland": "Flatland worlds",
        "rl": "Learning",
        "fields": "Potential fields",
        "layers": "Layers",
        "driving": "Driving",
        "teleop": "Driving",
    }
)


def topic_title(topic: str) -> str:
    """A topic's title in the report."""
    return TOPIC_TITLES.get(topic, topic)


@dataclass(frozen=True, slots=True, eq=False)
class ReportContext:
    """The input of every chapter."""

    data: ClassData
    score: FloatArray | None
    """Expertise by Algorithm 4; None where its six ratings were not asked."""
    divisions: tuple[ClassDivision, ...]
    """All divisions that are possible."""
    division: ClassDivision | None
    """The division that the tables use; None: the class is not divided."""
    seed: int

    @property
    def groups(self) -> tuple[StudentGroup, ...]:
        """Beginners and experts where the class is divided; then the whole class."""
        everybody = StudentGroup("overall", np.ones(len(self.data.names), dtype=np.bool_))
        return (*(self.division.groups if self.division is not None else ()), everybody)

    def group_difference_test(self, values: FloatArray) -> PermutationTestResult | None:
        """Tests the difference between experts and beginners; None where the class is not divided."""
        if self.division is None:
            return None
        first, second = self.division.experts.members, self.division.beginners.members
        return difference_test(values[first], values[second], np.random.default_rng(self.seed))


def means_table(
    identity: str,
    title: str,
    measures: Sequence[StudentMeasure],
    context: ReportContext,
    bounds: tuple[float, float] = SCALE_BOUNDS,
    note: str = "",
) -> Table:
    """A table with n, mean, SD and the mean's interval for each measure and group, and p of the groups' difference.

    An interval is cut off at ``bounds``, beyond which no mean can lie.
    """
    rows: list[tuple[Cell, ...]] = []
    for measure in measures:
        test = context.group_difference_test(measure.values)
        for i, group in enumerate(context.groups):
            stats = summary_statistics(measure.values[group.members])
            last = i == len(context.groups) - 1
            p = test.p_value if test is not None and last else ""
            interval = clip_interval(stats.interval, bounds)
            rows.append((measure.label, group.name, stats.n, stats.mean, stats.sd, interval, p))
    columns = (
        Column("", CellStyle.TEXT),
        Column("group", CellStyle.TEXT),
        Column("n"),
        Column("M"),
        Column("SD"),
        Column("95% of M"),
        Column("p", CellStyle.P_VALUE, 3),
    )
    divided = context.division is not None
    if any(isinstance(row[2], int) and row[2] < MIN_GROUP_SIZE for row in rows):
        note = f"{note} Groups with n below {MIN_GROUP_SIZE} are too small to speak for others.".strip()
    return Table(
        identity,
        title,
        columns if divided else columns[:-1],
        tuple(row if divided else row[:-1] for row in rows),
        note,
        grouped=True,
    )


def means_bars(
    identity: str,
    title: str,
    measures: Sequence[StudentMeasure],
    context: ReportContext,
    bounds: tuple[float, float] = SCALE_BOUNDS,
) -> BarChart:
    """A bar chart of the means: of the groups, or of the whole class where there are none."""
    groups = context.groups[:-1] or context.groups
    return BarChart(
        identity,
        title,
        tuple(group.name for group in groups),
        tuple(
            (each.label, tuple(summary_statistics(each.values[group.members]).mean for group in groups))
            for each in measures
        ),
        *bounds,
    )


def clip_interval(interval: ConfidenceInterval, bounds: tuple[float, float]) -> ConfidenceInterval:
    """Clips an interval to bounds; NaN stays."""
    low, high = bounds
    return ConfidenceInterval(
        max(interval.low, low) if interval.low == interval.low else interval.low,
        min(interval.high, high) if interval.high == interval.high else interval.high,
    )


def division_warnings(division: ClassDivision | None) -> tuple[Caution, ...]:
    """The warnings of a division."""
    if division is None:
        return ()
    return tuple(Caution(f"Division {division.title}: {text}.") for text in division.warnings)


def file_name_part(text: str) -> str:
    """The text in characters that suit a file name."""
    return "".join(c if c.isalnum() and c.isascii() else "-" for c in text.lower()) or "other"
