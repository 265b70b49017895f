"""The largest value and the success of each test, with and without the limit of values."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Final

from kit.document.blocks import (
    BarChart,
    Block,
    Cell,
    Column,
    Table,
    Text,
)
from kit.learning.training.measures import format_measure
from kit.study.printed_tables import (
    PrintedFigure,
)
from kit.study.recorded_results import Results
from kit.study.study_variants import StudyVariant


def value_blocks(figure: PrintedFigure, results: Results) -> list[Block]:
    """The largest value and the success of each test, with and without the limit of values; none where there are none."""
    tests = {name: result.tests_of(figure.group)[:1] for name, result in results.items()}
    sessions = {
        name: {each.steps: each for each in found[0].sessions} for name, found in tests.items() if found
    }
    steps = sorted({number for found in sessions.values() for number in found})
    if not steps:
        return []
    columns = [Column("steps")]
    for name in sessions:
        columns += [Column(f"{VALUE_TITLES[name]}: value"), Column("success", decimals=2)]
    rows, bars = [], []
    for number in steps:
        here = [found.get(number) for found in sessions.values()]
        cells: list[Cell] = [f"{number:,}"]
        for each in here:
            known = each is not None and each.value_max is not None
            cells += [format_measure(each.value_max) if known else None, each.share if each else None]  # type: ignore[union-attr, arg-type]  # known
        rows.append(tuple(cells))
        heights = tuple(
            math.log10(max(1.0, each.value_max))
            if each is not None and each.value_max is not None
            else math.nan
            for each in here
        )
        bars.append((f"{number:,} steps", heights))
    high = max(height for _, heights in bars for height in heights if not math.isnan(height))
    names = tuple(VALUE_TITLES[name] for name in sessions)
    title = f"{figure.title}: the largest value of the last 1,000 observations, seed 0"
    missing = [
        Text(f"{VALUE_TITLES[name]}: no recorded result; `{figure.run}` makes it.")
        for name in ("seed", "no-limit")
        if name not in sessions
    ]
    return [
        Table(f"figure-{figure.id}-values", title, tuple(columns), tuple(rows)),
        BarChart(f"figure-{figure.id}", "Its decimal logarithm", names, tuple(bars), 0.0, math.ceil(high)),
        *missing,
    ]


VALUE_TITLES: Final[Mapping[StudyVariant, str]] = {"seed": "limit 500", "no-limit": "no limit", "kit": "kit"}
