"""The list of all trainings as rows of text, and what is shown where there are none."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING, Final

from kit.dialogue.dialogue import Panel
from kit.document.blocks import Text, Tone, ToneText, labelled_table
from kit.document.layout import Page, rows_of
from kit.document.rows import Row, row
from kit.document.tables import list_rows
from kit.plain_text import format_size
from kit.tui.rows.panel_rows import panel_rows

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
        "Drive: c lets it drive. Game: a races it. League: e enters it.",
    ),
)
"""What can be done with a training, for whoever has none yet."""


def no_trainings(tasks: Sequence[LearningTask], chosen: int, width: int, height: int) -> list[Row]:
    """Says how to start the first training, and lists the tasks with the chosen one in sight; below them, where there is room,
    what can be done with a training, and what can learn the chosen task."""
    begin = "No trainings yet. Choose a task, and press t to start one: its cases, algorithm, reward and seed are asked."
    from kit.learning.authoring.task_text import tasks_table
    from kit.learning.tasks.actions import DiscreteActions
    from kit.learning.training.algorithms import ALGORITHMS, algorithms_for

    page = Page(width=width - 2, margin=1)
    rows = [*rows_of([Text(begin)], page), row()]
    rows += list_rows(tasks_table(tasks), width - 1, max(1, height - len(rows)), chosen)
    after = [row(), *rows_of([labelled_table(AFTERWARDS)], page)]
    rows += after if len(rows) + len(after) <= height else []
    if not tasks or len(rows) >= height:
        return rows
    is_continuous = not isinstance(tasks[chosen].actions, DiscreteActions)
    able = [ALGORITHMS[name] for name in algorithms_for(is_continuous=is_continuous)]
    table = labelled_table(
        (ToneText(each.name, Tone.BOLD), f"{each.title} ({each.library})") for each in able
    )
    panel = Panel(f"algorithms that can learn {tasks[chosen].name}", (table,))
    below = panel_rows([panel], width - 2, height - len(rows))
    return [*rows, *(row(" ", *each) if each else each for each in below)]


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
