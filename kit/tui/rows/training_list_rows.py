"""The list of trainings, and the settings of a new one, as rows of text. Pure."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING, Final

from kit.tui.widgets.text_rows import Row, row

if TYPE_CHECKING:  # of no use to the first frame: the learning side brings Gymnasium along
    from kit.learning.training.run_upkeep import RunOverview

STATE_WIDTH: Final = 11
FIGURES_WIDTH: Final = 33
"""Steps, best, disk, left."""
STATE_STYLES: Final = {
    "running": "good",
    "paused": "warn",
    "finished": "",
    "stopped": "warn",
    "interrupted": "warn",
    "failed": "bad",
    "new": "dim",
}
EMPTY: Final = (
    "No trainings yet.",
    "",
    "t begins one: choose a task, its cases,",
    "an algorithm, a reward, a seed.",
)


def training_list(
    runs: Sequence[RunOverview], chosen: int, marked: Collection[str], width: int, height: int
) -> list[Row]:
    """A head and as many rows as there is room for, the chosen one among them."""
    if not runs:
        return [row(f" {line}") for line in EMPTY]
    name_width = max(
        12, min(width - STATE_WIDTH - FIGURES_WIDTH - 6, max(len(each.run.name) for each in runs))
    )
    head = f"   {'run':{name_width}}  {'state':{STATE_WIDTH}} {'steps':>9}  {'best':>5}  {'disk':>7}  left"
    room = max(1, height - 1)
    first = max(0, min(chosen - room // 2, len(runs) - room))
    shown = runs[first : first + room]
    return [
        row((head[:width], "dim")),
        *(
            _run_row(each, name_width, is_chosen=first + place == chosen, is_marked=each.run.name in marked)
            for place, each in enumerate(shown)
        ),
    ]


def _run_row(each: RunOverview, name_width: int, *, is_chosen: bool, is_marked: bool) -> Row:
    from kit.learning.training.run_text import success_shares
    from kit.learning.training.run_upkeep import format_seconds, size_text

    head = row(
        (">" if is_chosen else " ", "bold"),
        ("*" if is_marked else " ", "warn"),
        (f" {each.run.name:{name_width}.{name_width}} ", "chosen" if is_chosen else ""),
        " ",
    )
    summary = each.summary
    if summary is None:
        return (*head, (f"{'damaged':{STATE_WIDTH}}", "bad"), (f" {size_text(each.disk_bytes):>25}", "dim"))
    best = "-"
    if summary.best_evaluation is not None:
        shares = success_shares(summary.best_evaluation).values()
        best = f"{sum(shares) / len(shares):.2f}"
    left = "" if each.remaining_s is None else f"  {format_seconds(each.remaining_s)}"
    return (
        *head,
        (f"{summary.state:{STATE_WIDTH}}", STATE_STYLES[summary.state]),
        (f" {summary.steps:>9,}  {best:>5}  {size_text(each.disk_bytes):>7}", ""),
        (left, "bold"),
    )


def about_run(each: RunOverview | None, total_bytes: int, width: int) -> Row:
    """What the chosen run learns, and the disk that all take."""
    if each is None:
        return row()
    from kit.learning.training.run_upkeep import size_text

    if each.problem:
        return row((each.problem[:width], "bad"))
    return row((f"{each.title}   all runs: {size_text(total_bytes)}"[:width], "dim"))


def _end_of(value: str, room: int) -> str:
    """A value in its room: of a path that is too long, the end says which file it is."""
    return value if len(value) <= room else f"...{value[3 - room :]}"


def settings(entries: Sequence[tuple[str, str, str]], chosen: int, width: int) -> list[Row]:
    """One block for each setting: its name, its value and what it means."""
    rows: list[Row] = []
    for number, (name, value, about) in enumerate(entries):
        is_chosen = number == chosen
        rows.append(
            row(
                (">" if is_chosen else " ", "bold"),
                (f" {name:12}", "bold" if is_chosen else ""),
                (_end_of(value, max(4, width - 15)), "bold"),
            )
        )
        rows += [row("              ", (about[: max(1, width - 15)], "dim")), row()]
    return rows
