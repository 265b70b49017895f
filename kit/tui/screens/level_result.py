"""The end of a drive: medal and stars one by one, the difference to others, sectors, and what to do next."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Final, Literal, TypeAlias

from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Vertical
from textual.screen import ModalScreen

from kit.school.game.drive_records import card_rows, save_card
from kit.school.game.player_progress import Medal
from kit.tui.rows import level_rows
from kit.tui.rows.key_rows import bindings, footer
from kit.tui.screens.message_dialog import MessageDialog, wrapped
from kit.tui.widgets.text_rows import Row, TextRows, row

if TYPE_CHECKING:
    from kit.run.recording import Recording
    from kit.school.game.drive_records import DriveRecord
    from kit.school.game.ghosts import Ghost, Split
    from kit.school.game.levels import GameLevel
    from kit.school.game.race import DriverKind, RaceFinish
    from kit.tui.theme import Theme
    from kit.workspace import Workspace

REVEAL_INTERVAL: Final = 0.3
"""Between two rows that appear [s]."""
BELL_VARIABLE: Final = "KIT_BELL"
"""Set to 1, the terminal's bell rings with a new medal."""
WIDTH: Final = 74
FINISH_WIDTH: Final = 40
"""Columns of the photo finish."""

Wish: TypeAlias = Literal["next", "restart", "back"]
"""What the player wants after a drive."""


@dataclass(frozen=True, slots=True, eq=False)
class DriveResult:
    """Everything that is shown of a drive that has ended."""

    level: GameLevel
    driver: DriverKind
    finish: RaceFinish
    record: DriveRecord
    recording: Recording
    ghosts: Sequence[Ghost]
    reference: float | None
    splits: Sequence[Split]


class DriveResultDialog(ModalScreen[Wish]):
    """What a drive earned. A driving key that is still held does not close it."""

    BINDINGS: ClassVar[list[BindingType]] = bindings("level result")
    DEFAULT_CSS = f"""
    DriveResultDialog {{ align: center middle; }}
    DriveResultDialog > Vertical {{ width: {WIDTH}; max-width: 100%; height: auto; max-height: 100%; border: solid $foreground; padding: 0 1; }}
    DriveResultDialog TextRows {{ height: auto; }}
    """

    def __init__(self, theme: Theme, result: DriveResult, workspace: Workspace) -> None:
        super().__init__()
        self._theme = theme
        self._result = result
        self._workspace = workspace
        finish, record = result.finish, result.record
        self._fixed = [
            row((f" {result.level.title}, {level_rows.WHO[result.driver]}", "bold")),
            *wrapped(f" {level_rows.finish_sentence(finish)}"),
            row(),
        ]
        self._revealed: list[Row] = [
            *level_rows.earned(result.level, finish, record),
            *level_rows.compared(finish, record, result.reference, result.ghosts),
            *level_rows.sector_rows(result.splits),
            *photo_finish(result),
            *(row((f"   opened: {level.title}", "good")) for level in record.unlocked),
        ]
        self._shown = 0

    def compose(self) -> ComposeResult:
        with Vertical() as box:
            box.border_title = "The end of this drive"
            yield TextRows()

    def on_mount(self) -> None:
        self._show()
        record = self._result.record
        if os.environ.get(BELL_VARIABLE) == "1" and record.medal > max(Medal.NONE, record.previous_medal):
            self.app.bell()
        self._timer = self.set_interval(REVEAL_INTERVAL, self._reveal)

    def _reveal(self) -> None:
        self._shown += 1
        if self._shown >= len(self._revealed):
            self._timer.stop()
        self._show()

    def _show(self) -> None:
        without = () if self._result.finish.reached else ("next",)
        keys = footer("level result", WIDTH - 4, without=without, keys={"next": "Enter"})
        hidden = [row()] * max(0, len(self._revealed) - self._shown)  # the box keeps its size
        rows = [*self._fixed, *self._revealed[: self._shown], *hidden, row(), keys]
        self.query_one(TextRows).show(rows)

    # Keys

    def action_next(self) -> None:
        """First everything is shown, then the next level comes."""
        if self._shown < len(self._revealed):
            self._shown = len(self._revealed)
            self._timer.stop()
            self._show()
        elif self._result.finish.reached:
            self.dismiss("next")

    def action_restart(self) -> None:
        self.dismiss("restart")

    def action_back(self) -> None:
        self.dismiss("back")

    def action_replay(self) -> None:
        """The film of this drive."""
        from kit.tui.screens.lesson_drive import RecordingScreen

        result = self._result
        self.app.push_screen(
            RecordingScreen(self._theme, result.level.find_scenario(), result.recording, "a drive")
        )

    def action_share(self) -> None:
        """The card of this drive, on the screen and in a file."""
        result = self._result
        rows = card_rows(result.level, result.driver, result.finish, result.record.medal, result.recording)
        try:
            saved = [f"Saved as {save_card(self._workspace, result.level, result.driver, rows)}."]
        except OSError as error:
            saved = [f"It could not be saved: {error.strerror}."]
        if result.record.recording is not None:
            saved.append(f"kit replay {result.record.recording} --export drive.gif makes a moving picture.")
        shown = [*(row(each) for each in rows), row(), *wrapped("\n".join(saved))]
        self.app.push_screen(MessageDialog("A card to share", shown))


def photo_finish(result: DriveResult) -> list[Row]:
    """Where everybody was when the first one was at the goal: a line each, the goal at its right end."""
    mine = result.level.find_scenario().partners
    tracks = [
        ("you", result.finish.seconds, result.recording.track(mine[0])[:, :2], result.recording.step_size)
    ]
    own = {driver.value: f"best {who}" for driver, who in level_rows.WHO.items()}
    tracks += [
        (own.get(ghost.name, ghost.name), ghost.seconds, ghost.tracks[0][:, :2], ghost.step_size)
        for ghost in result.ghosts
        if ghost.tracks
    ]
    if not result.finish.reached or len(tracks) < 2:
        return []
    first = min(seconds for _, seconds, _, _ in tracks)
    rows: list[Row] = [row(("   photo finish", "dim"))]
    for name, seconds, track, step in sorted(tracks, key=lambda each: each[1])[:4]:
        missing = 0.0
        if seconds > first:
            rest = track[min(round(first / step), len(track) - 1) :]
            missing = float(sum(((rest[1:] - rest[:-1]) ** 2).sum(axis=1) ** 0.5))
        column = FINISH_WIDTH - 1 - min(FINISH_WIDTH - 1, round(missing * 10.0))
        line = "." * column + ">" + " " * (FINISH_WIDTH - 1 - column) + "|"
        rows.append(
            row(f"   {name:<15.15} ", (line, "good" if name == "you" else "dim"), f" {missing:.2f} m")
        )
    return rows
