"""A task beside the form for a new training: its map with starts and targets, what a step earns, and how long it will take."""

from __future__ import annotations

from asyncio import to_thread
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final, Protocol

from textual import work
from textual.app import ComposeResult
from textual.containers import Vertical

from kit.document.blocks import Block, Text, labelled_table
from kit.document.layout import Page, rows_of
from kit.document.rows import row
from kit.plain_text import counted
from kit.tui.rows.training_rows import clock
from kit.tui.theme import Theme
from kit.tui.widgets.text_rows import TextRows
from kit.tui.widgets.world_view import WorldView

if TYPE_CHECKING:
    from kit.learning.training.past_runs import ExpectedTime
    from kit.learning.training.run_config import RunConfig
    from kit.render.scene import Scene

MARGIN: Final = 2
LEAST_MAP_ROWS: Final = 8


class TellsConfig(Protocol):
    """What has been chosen so far; two that are equal are the same training."""

    def config(self) -> RunConfig: ...


class TaskPreview(Vertical):
    """Reads the task in another thread whenever another one is chosen."""

    DEFAULT_CSS = """
    TaskPreview WorldView { height: 1fr; }
    TaskPreview TextRows { height: auto; }
    """

    def __init__(self, theme: Theme, runs: Path, *, is_overview: bool = False) -> None:
        """``is_overview``: what a step earns is left out where all of it has no room, and the map has that room."""
        super().__init__()
        self._is_overview = is_overview
        self._runs = runs
        self._told: TellsConfig | None = None
        self._world = WorldView(lambda: theme.encoder, theme.palette)
        self._text = TextRows()
        self._blocks: Sequence[Block] = ()
        """What is said of the task."""

    def compose(self) -> ComposeResult:
        yield self._world
        yield self._text

    def tell(self, choices: TellsConfig) -> None:
        """Shows the task of these choices from now on."""
        if choices != self._told:
            self._told = choices
            self._read(choices)

    @work(exclusive=True)
    async def _read(self, choices: TellsConfig) -> None:
        try:
            scene, blocks = await to_thread(_task_told, self._runs, choices.config())
        except Exception as error:  # noqa: BLE001 - a damaged task file, a world that is away: all of it is told
            scene, blocks = None, [Text(str(error))]
        if not self.is_attached:
            return
        if scene is None:
            self._world.clear()
        else:
            self._world.show(scene)
        self._blocks = blocks
        self._show_text()

    def on_resize(self) -> None:
        """A task may have been read before there was any room."""
        self._show_text()

    def _show_text(self) -> None:
        page, room = Page(max(20, self.size.width - 2 * MARGIN), MARGIN), self.size.height - LEAST_MAP_ROWS
        rows = [row(), *rows_of(self._blocks, page)]
        if self._is_overview and len(rows) > room:
            rows = [row(), *rows_of(self._blocks[:1], page)]
        self._text.show_all(rows[: max(0, room)])


def _task_told(runs: Path, config: RunConfig) -> tuple[Scene, Sequence[Block]]:
    """The picture of the task's first case and what is said of it. The learning side takes a moment to import."""
    from kit.learning.authoring.task_text import build_case_scene, reward_blocks
    from kit.learning.training.past_runs import expected_time

    task = config.choice.resolve()
    cases = task.map_cases()
    card, case = cases[0]
    shown = f"{card.name}" if len(cases) == 1 else f"{case.name}, the first of {counted(len(cases), 'case')}"
    about = [
        ("task", task.summary or task.name),
        ("map", f"{shown}; S is a start"),
        ("success", task.goal.description),
        ("time", time_told(expected_time(runs, config))),
    ]
    earns = (
        [Text(f"what reward() in {config.reward_file} returns", lead="earns")]
        if config.reward_file
        else reward_blocks(task)
    )
    return build_case_scene(task, card, case), [labelled_table(about), *earns]


def time_told(expected: ExpectedTime) -> str:
    """How long it will take, as far as trainings on this machine tell it."""
    most = f"at most {expected.most_steps:,} steps"
    if expected.most_seconds is not None:
        most += f", {clock(expected.most_seconds)} at the rate of the last training"
    if expected.usual_seconds is None:
        return f"{most}; no training like it has ended here yet"
    count = len(expected.like_it)
    return f"{clock(expected.usual_seconds)}, as {counted(count, 'training')} like it took here; {most}"
