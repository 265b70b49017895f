"""The list of all trainings as rows of text, and what is shown where there are none."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING, Final

from kit.document.blocks import Text, Tone, ToneText, labelled_table
from kit.document.layout import Page, rows_of
from kit.document.rows import Row, row
from kit.document.tables import list_rows
from kit.plain_text import format_size

if TYPE_CHECKING:
    from kit.learning.tasks.learning_task import LearningTask
    from kit.learning.training.run_upkeep import RunOverview


AFTERWARDS: Final = (
    (
        ToneText("while it trains", Tone.BOLD),
        "Enter shows its curves and how its newest policy drives; leaving stops nothing.",
    ),
    (
        ToneText("once it has", Tone.BOLD),
        "e tests it on new episodes, k under disturbances, o compares the marked ones.",
    ),
    (
        ToneText("where it drives", Tone.BOLD),
        "Drive: c lets it drive. Levels: a races it. League: e enters it.",
    ),
)
"""What can be done with a training, for whoever has none yet."""


def no_trainings(tasks: Sequence[LearningTask], width: int, height: int) -> list[Row]:
    """Says how to start the first training, and lists the tasks, as far as there is room."""
    begin = (
        "No trainings yet. Press t to start one: choose a task, its cases, an algorithm, a reward, a seed."
    )
    from kit.learning.authoring.task_text import tasks_table

    page = Page(width=width - 2, margin=1)
    rows = rows_of([Text(begin), tasks_table(tasks)], page)
    after = [row(), *rows_of([labelled_table(AFTERWARDS)], page)]
    if len(rows) <= height:
        return [*rows, *after] if len(rows) + len(after) <= height else rows
    return [*rows[: max(0, height - 1)], row((" ... and more: kit task list", "dim"))]


def training_list(
    runs: Sequence[RunOverview], chosen: int, marked: Collection[str], width: int, height: int
) -> list[Row]:
    """The table of the runs, with the chosen one in sight."""
    from kit.learning.training.run_upkeep import runs_table

    places = [place for place, each in enumerate(runs) if each.run.name in marked]
    return list_rows(runs_table(runs), width, height, chosen, places)


def about_run(each: RunOverview | None, total_bytes: int, width: int) -> Row:
    """What the chosen run learns, and the disk that all take."""
    if each is None:
        return row()
    if each.problem:
        return row((each.problem[:width], "bad"))
    return row((f"{each.title}   all runs: {format_size(total_bytes)}"[:width], "dim"))
