"""What a class did and did not reach, criterion by criterion, as a document: means, discrimination, and the points of all."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from grader.assignment import Assignment
from grader.cohort.gradebook import GradebookRow, summary
from kit.document.blocks import Block, CellStyle, Chapter, Column, Document, Histogram, Table, Text
from kit.plain_text import counted

BINS = 10
HARD_BELOW = 0.5
"""A criterion of which the class earns less than this share is worth a lesson."""


def class_document(assignment: Assignment, table: Sequence[GradebookRow]) -> Document:
    """Returns the page on a class: how it did as a whole, on each criterion, and what to explain again."""
    graded = [row for row in table if row.points is not None]
    blocks: list[Block] = [Text(f"{summary(table)}.")]
    if graded:
        blocks += [_points_plot(graded), criterion_table(assignment, graded)]
        hard = hardest(assignment, graded)
        if hard:
            blocks.append(Text(f"Worth explaining again: {hard}."))
    return Document(assignment.title, (Chapter("class", "The class", tuple(blocks)),))


def criterion_table(assignment: Assignment, graded: Sequence[GradebookRow]) -> Table:
    """Returns how the class did on each criterion."""
    columns = (
        Column("criterion", CellStyle.TEXT),
        Column("points"),
        Column("mean"),
        Column("share"),
        Column("all points", CellStyle.TEXT),
        Column("discrimination"),
    )
    rows = []
    for test in assignment.tests:
        earned = [row.tests[test.id] for row in graded if test.id in row.tests]
        if not earned:
            continue
        full = sum(points >= test.points - 1e-9 for points in earned)
        mean = math.fsum(earned) / len(earned)
        rows.append(
            (
                test.title,
                float(test.points),
                mean,
                mean / test.points if test.points else math.nan,
                f"{full} of {len(earned)}",
                discrimination(graded, test.id),
            )
        )
    note = (
        "Share: of the points. Discrimination: the correlation of a criterion with the points of all others; about 0 or "
        "below: it tells good works from weak ones by chance alone, or not at all."
    )
    return Table(
        "criteria",
        f"{counted(len(graded), 'graded work')}, criterion by criterion",
        columns,
        tuple(rows),
        note,
    )


def discrimination(graded: Sequence[GradebookRow], criterion: str) -> float:
    """Returns Pearson's correlation of the criterion's points with the sum of all others, -1 to 1; NaN where one of them is the
    same for all."""
    rows = [row for row in graded if criterion in row.tests]
    own = [row.tests[criterion] for row in rows]
    rest = [math.fsum(points for name, points in row.tests.items() if name != criterion) for row in rows]
    return _correlation(own, rest)


def _correlation(x: Sequence[float], y: Sequence[float]) -> float:
    mean_x, mean_y = math.fsum(x) / len(x), math.fsum(y) / len(y)
    xx = math.fsum((a - mean_x) ** 2 for a in x)
    yy = math.fsum((b - mean_y) ** 2 for b in y)
    if xx <= 1e-12 or yy <= 1e-12:
        return math.nan
    return math.fsum((a - mean_x) * (b - mean_y) for a, b in zip(x, y, strict=True)) / math.sqrt(xx * yy)


def hardest(assignment: Assignment, graded: Sequence[GradebookRow]) -> str:
    """Names the criteria of which the class earned less than half, the hardest first; empty if there are none."""
    shares: Mapping[str, float] = {
        test.title: math.fsum(earned) / len(earned) / test.points
        for test in assignment.tests
        if test.points and (earned := [row.tests[test.id] for row in graded if test.id in row.tests])
    }
    low = sorted((share, title) for title, share in shares.items() if share < HARD_BELOW)
    return ", ".join(f"“{title}” ({share:.0%})" for share, title in low)


def _points_plot(graded: Sequence[GradebookRow]) -> Histogram:
    most = max(row.max_points for row in graded) or 1.0
    finals = [min(max(row.final or 0.0, 0.0), most) for row in graded]
    edges = tuple(most * i / BINS for i in range(BINS + 1))
    counts = [0] * BINS
    for final in finals:
        counts[min(BINS - 1, int(final / most * BINS))] += 1
    return Histogram("points", "Final points", edges, tuple(counts))
