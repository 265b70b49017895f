"""The table of a training's seeds: the best test of each, and its best agent on fresh episodes."""

from __future__ import annotations

from typing import Final

from kit.document.blocks import (
    Cell,
    CellStyle,
    Column,
    Table,
)
from kit.learning.training.measures import format_measure
from kit.study.printed_tables import (
    ADJACENCY,
    ADJACENCY_BY_POSES,
    PrintedTable,
)
from kit.study.recorded_results import RecordedResult, RecordedTest, Results, pooled_cell
from kit.study.study_variants import StudyVariant
from kit.study.trained_seeds import TrainedSeeds


def seeds_table(table: PrintedTable, results: Results) -> Table:
    """One row for each seed: the best of its tests, as the print is one, and its best agent on fresh episodes."""
    rows: list[tuple[Cell, ...]] = []
    settings_of: dict[StudyVariant, str] = {
        "seed": table.settings_of,
        "no-limit": f"{table.settings_of}, no limit",
    }
    if table.kit_task == table.repeat_task:  # an agent of another task is no row of this table
        settings_of["kit"] = "kit"
    for variant, settings in settings_of.items():
        result = results.get(variant)
        for row, group in zip(table.rows, table.row_groups, strict=False):
            seeds = TrainedSeeds.of(table, result, group)
            if result is not None:
                rows += [(row, settings, *_seed_cells(result, test)) for test in seeds.tests]
            missing = seeds.planned - len(seeds.tests)
            if missing and variant != "kit":  # of which one seed is enough
                rows.append((row, settings, f"{missing} of {seeds.planned}: not trained yet", *[None] * 8))
    columns = (
        Column("", CellStyle.TEXT),
        Column("settings", CellStyle.TEXT),
        Column("seed", CellStyle.TEXT),
        *(Column(title) for title in ("at most", "steps")),
        Column("best test", decimals=2),
        Column("value"),
        Column("fresh", decimals=2),
        Column("rays", decimals=2),
        Column("poses", decimals=2),
        Column("of"),
    )
    return Table(
        f"table-{table.id.replace('.', '-')}-seeds",
        "Trained again: the best test of each seed, as the print is the best of up to 100 tests of one",
        columns,
        tuple(rows),
        note=SEEDS_NOTE,
    )


SEEDS_NOTE: Final = (
    "at most, steps: of training, which ends with a test of 0.8 or more. best test: 100 episodes. value: the largest in any test. "
    "fresh: success of that agent on fresh episodes. rays, poses: its adjacency, the share of steps side by side by rays "
    "(equations 4.7 to 4.9) and by poses (4.2 to 4.6), over the fresh episodes that reached the target; of: how many these are."
)


def _seed_cells(result: RecordedResult, test: RecordedTest) -> tuple[Cell, ...]:
    episodes = test.episodes * len(test.own_cases)
    sides = [pooled_cell((test,), measure) for measure in (ADJACENCY, ADJACENCY_BY_POSES)]
    best = test.best_session
    return (
        f"{test.seed}",
        f"{result.settings.most_steps:,}",
        f"{test.steps:,}",
        None if best is None else best.share,
        None if test.largest_value is None else format_measure(test.largest_value),
        sum(test.reached[case] for case in test.own_cases) / max(1, episodes),
        *(None if side is None else side.value for side in sides),
        None if sides[0] is None else f"{sides[0].episodes}",
    )
