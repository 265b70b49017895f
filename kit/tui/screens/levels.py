"""The map of levels: stars, what is open, who was quickest; Enter drives one."""

from __future__ import annotations

from asyncio import to_thread
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Final

from textual import events, work
from textual.app import ComposeResult
from textual.binding import BindingType

from kit.controllers import kit_controllers, user_controllers
from kit.school.game import leaderboard
from kit.school.game.drive_records import DriveRecord, record_drive
from kit.school.game.ghosts import Ghost, ghosts_folder, load_ghosts, load_reference_ghost
from kit.school.game.levels import GameLevel, all_levels
from kit.school.game.player_progress import LevelProgress, completed_lessons, level_progress
from kit.school.game.race import DriverKind, RaceFinish, race_agent, race_controller
from kit.school.progress import ProgressError, ProgressJournal
from kit.tui.rows import level_rows
from kit.tui.rows.key_rows import bindings, footer
from kit.tui.screens.message_dialog import HelpDialog, MessageDialog, wrapped
from kit.tui.screens.picker import Picker, PickerItem
from kit.tui.textual_patches import ActivePaintScreen
from kit.tui.theme import Theme
from kit.tui.widgets.text_rows import Row, TextRows, row, spread

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import TypeAlias

    from kit.run.recording import Recording
    from kit.workspace import Workspace

    _Drive: TypeAlias = Callable[[GameLevel], tuple[RaceFinish, Recording]]
    _Tell: TypeAlias = Callable[[float], None]

ABOUT_ROWS: Final = 4
BEST: Final = 3
"""Rows of the leaderboard per level."""
STARS: Final = (
    ("first star", "finished"),
    ("second star", "finished, and touched nothing"),
    ("third star", "finished in less time than par"),
    ("---", "opens when you have finished the level before it"),
)


class LevelsScreen(ActivePaintScreen[None]):
    """Draws nothing but what a key has changed."""

    AUTO_FOCUS = ""
    BINDINGS: ClassVar[list[BindingType]] = bindings("levels")
    DEFAULT_CSS = f"""
    LevelsScreen {{ layout: vertical; }}
    LevelsScreen #heading {{ height: 1; }}
    LevelsScreen #map {{ height: 1fr; }}
    LevelsScreen #about {{ height: {ABOUT_ROWS}; }}
    LevelsScreen #keys {{ height: 1; }}
    """

    def __init__(
        self, theme: Theme, journal: ProgressJournal, workspace: Workspace, level: GameLevel | None = None
    ) -> None:
        """``level``: opened at once."""
        super().__init__()
        self._theme = theme
        self._progress = journal
        self._workspace = workspace
        self._levels = all_levels()
        self._first = level
        self._found: tuple[LevelProgress, ...] = ()
        self._known: dict[str, tuple[tuple[Ghost, ...], Ghost | None]] = {}
        self._doing = ""
        self._at = 0 if level is None else [each.id for each in self._levels].index(level.id)

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        yield TextRows(id="map")
        yield TextRows(id="about")
        yield TextRows(id="keys")

    def on_mount(self) -> None:
        self._read()
        if self._first is None:
            self._at = next(
                (number for number, each in enumerate(self._found) if each.is_open and each.star_count < 3), 0
            )
        self._load_ghosts()
        if self._first is not None:
            self.action_open()

    def on_resize(self, event: events.Resize) -> None:
        self.call_after_refresh(self._show)

    @property
    def chosen(self) -> LevelProgress:
        return self._found[self._at]

    def _read(self) -> None:
        events = self._progress.events()
        self._found = level_progress(self._levels, events, completed_lessons(self._levels, events))

    def _show(self) -> None:
        # The kit may be left while a ghost is being made: then there are no rows any more.
        if not self.size.width or not self._found or not self.query(TextRows):
            return
        have = sum(each.star_count for each in self._found)
        right = row((f"{have} of {3 * len(self._found)} stars ", "bold"))
        self._rows("heading").show(
            [
                spread(
                    row(("The game", "bold"), ("  * finished  * touched nothing  * under par", "dim")),
                    right,
                    self.size.width,
                )
            ]
        )
        self._rows("map").show([row(), *level_rows.level_map(self._found, self._at)])
        near, reference = self._known.get(self.chosen.level.id, ((), None))
        about: list[Row] = level_rows.about(self.chosen, near, reference)
        self._rows("about").show([*about, row((self._doing, "bold"))] if self._doing else about)
        self._rows("keys").show([footer("levels", self.size.width, labels={"open": "drive"})])

    @work(exclusive=True, group="ghosts")
    async def _load_ghosts(self) -> None:
        """The ghosts of the chosen level: the reference's takes a moment the first time."""
        level = self.chosen.level
        self._show()
        if level.id not in self._known and self.chosen.is_open:
            self._known[level.id] = await to_thread(self._ghosts_of, level)
            self._show()

    def _ghosts_of(self, level: GameLevel) -> tuple[tuple[Ghost, ...], Ghost | None]:
        return load_ghosts(self._workspace, level), load_reference_ghost(self._workspace, level)

    def _rows(self, name: str) -> TextRows:
        return self.query_one(f"#{name}", TextRows)

    # Keys

    def action_choose(self, columns: int, rows: int) -> None:
        """The level so many to the right, or so many rows below."""
        self._at = max(0, min(self._at + columns, len(self._found) - 1))
        grid = level_rows.grid(self._found)
        at = self.chosen.level.row
        column = grid[at].index(self._at)
        to = grid[max(0, min(at + rows, len(grid) - 1))]
        self._at = to[min(column, len(to) - 1)]
        self._load_ghosts()

    def action_help(self) -> None:
        self.app.push_screen(HelpDialog("Levels", "levels", STARS))

    @work(exclusive=True, group="drive")
    async def action_open(self) -> None:
        if not self._may_drive():
            return
        from kit.tui.screens.level_drive import LevelDrive

        level = self.chosen.level
        if level.id not in self._known:
            self._known[level.id] = await to_thread(self._ghosts_of, level)
        near, reference = self._known[level.id]
        shown = [*near, *([] if reference is None else [reference])]
        await self.app.push_screen_wait(
            LevelDrive(self._theme, level, shown, self._progress, self._workspace)
        )
        self._refresh_after_drive(level)

    @work(exclusive=True, group="drive")
    async def action_hand_over(self) -> None:
        if not self._may_drive():
            return
        files = {
            str(each.file): each
            for each in (*user_controllers(self._workspace.controllers), *kit_controllers())
        }
        choices = [PickerItem(key, each.name, each.title) for key, each in files.items()]
        picked = await self.app.push_screen_wait(
            Picker(f"Who drives? Yours are in {self._workspace.controllers}", choices)
        )
        if picked is not None:
            await self._race(
                DriverKind.CONTROLLER,
                lambda level: race_controller(level, files[picked], on_second=self._report_race_time),
            )

    @work(exclusive=True, group="drive")
    async def action_agent(self) -> None:
        if not self._may_drive():
            return
        names = await to_thread(_runs, self._workspace.runs)
        if not names:
            text = "No agent has been trained yet. `kit train turn` trains one; on the start screen it is `train`."
            self.app.push_screen(MessageDialog("Agents", wrapped(text)))
            return
        choices = [PickerItem(name, name, "") for name in names]
        picked = await self.app.push_screen_wait(Picker("Which agent drives?", choices))
        if picked is not None:
            await self._race(
                DriverKind.AGENT,
                lambda level: _race_agent(level, self._workspace.runs, picked, self._report_race_time),
            )

    def action_replay(self) -> None:
        level = self.chosen.level
        near, reference = self._known.get(level.id, ((), None))
        files = [
            file
            for each in (*near, *([reference] if reference else []))
            for file in sorted(ghosts_folder(self._workspace).glob(f"{level.id}.{each.name}*.npz"))
        ]
        if not files:
            self.app.push_screen(
                MessageDialog(
                    "Nothing to replay yet",
                    wrapped("Drive this level first, then its best drive can be replayed."),
                )
            )
            return
        self._choose_replay(files)

    @work(exclusive=True, group="drive")
    async def _choose_replay(self, files: list[Path]) -> None:
        choices = [PickerItem(str(file), file.name.split(".")[1], "") for file in files]
        picked = await self.app.push_screen_wait(Picker("Replay whose drive?", choices))
        if picked is not None:
            from kit.run.recording import RecordingError, load_recording
            from kit.tui.screens.lesson_drive import RecordingScreen

            try:
                recording = await to_thread(load_recording, Path(picked))
            except (RecordingError, OSError) as error:
                self.app.push_screen(MessageDialog("This drive cannot be replayed", wrapped(str(error))))
                return
            await self.app.push_screen_wait(
                RecordingScreen(self._theme, self.chosen.level.find_scenario(), recording, "a drive")
            )

    def action_hall_of_fame(self) -> None:
        found = leaderboard.read_entries(leaderboard.leaderboard_folder())
        rows: list[Row] = [row()]
        for level in self._levels:
            best = [each for each in found if each.level == level.id][:BEST]
            if best:
                names = ", ".join(
                    f"{each.name} {each.seconds:.1f} s {level_rows.WHO[each.driver]}" for each in best
                )
                rows += wrapped(f" {level.title}: {names}")
        if not found:
            rows += wrapped("The leaderboard of this machine is empty.")
        rows += [
            row(),
            *wrapped("`kit game join` puts your name and times there, `kit game leave` takes them out."),
        ]
        self.app.push_screen(MessageDialog("Leaderboard", rows))

    def action_back(self) -> None:
        if len(self.app.screen_stack) > 2:
            self.dismiss()
        else:
            self.app.exit()

    # Races

    def _may_drive(self) -> bool:
        if self._doing or not self.is_active:
            return False
        if not self.chosen.is_open:
            self.app.push_screen(
                MessageDialog(
                    "Not open yet",
                    wrapped(
                        f"{self.chosen.level.title} opens when you have finished {' or '.join(self.chosen.level.opened_by)}."
                    ),
                )
            )
            return False
        return True

    async def _race(self, driver: DriverKind, drive: _Drive) -> None:
        """Has somebody else drive, off the screen, and shows what came of it."""
        level = self.chosen.level
        self._doing = "The program or agent drives ..."
        self._show()
        try:
            finish, noted = await to_thread(self._race_and_record, driver, level, drive)
        except (LookupError, ValueError, OSError, ProgressError) as error:
            self._doing = ""
            self._show()
            self.app.push_screen(MessageDialog("The drive could not start", wrapped(str(error))))
            return
        self._doing = ""
        reference = self._known.get(level.id, ((), None))[1]
        self._refresh_after_drive(level)
        self.app.push_screen(
            MessageDialog(
                "The end of this drive", level_rows.result(level.title, level.par, finish, noted, reference)
            )
        )

    def _race_and_record(
        self, driver: DriverKind, level: GameLevel, drive: _Drive
    ) -> tuple[RaceFinish, DriveRecord]:
        finish, recording = drive(level)
        return finish, record_drive(self._progress, self._workspace, level, driver, finish, recording)

    def _report_race_time(self, seconds: float) -> None:
        """Called in the race's thread."""
        if seconds % 5.0 < 0.1:
            self.app.call_from_thread(self._show_race_time, f"The program or agent drives: {seconds:.0f} s")

    def _show_race_time(self, text: str) -> None:
        if self._doing:
            self._doing = text
            self._show()

    def _refresh_after_drive(self, level: GameLevel) -> None:
        """A drive has ended: stars and ghosts may be others now."""
        self._known.pop(level.id, None)
        self._read()
        self._load_ghosts()


def _runs(folder: Path) -> list[str]:
    from kit.learning.training.runs import list_runs

    return [run.name for run in list_runs(folder)]


def _race_agent(level: GameLevel, runs: Path, name: str, tell: _Tell) -> tuple[RaceFinish, Recording]:
    from kit.learning.policies.policies import PolicyError
    from kit.learning.training.runs import RunError, find_run

    try:
        return race_agent(level, find_run(runs, name).policy(), on_second=tell)
    except (PolicyError, RunError) as error:
        raise ValueError(str(error)) from None
