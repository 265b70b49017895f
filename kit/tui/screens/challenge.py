"""One challenge without driving: what it asks for, the file of the answer, its check, and what the answer is worth."""

from __future__ import annotations

import threading
import time
from asyncio import to_thread
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Final, Literal

from textual import events, work
from textual.app import ComposeResult
from textual.binding import BindingType

from kit.dialogue.actions import ScreenActions
from kit.document.rows import Row, broken, row, row_width, side_by_side
from kit.host.file_watcher import FileWatcher
from kit.learning.training.run_folders import list_runs
from kit.school.game.challenge import AnswerError, AnswerSubmission, Challenge
from kit.school.game.challenges import (
    answers_folder,
    challenge_events,
    challenge_medals,
    prepare_answer,
    record_judgement,
)
from kit.school.game.judgement import Judgement
from kit.school.game.medal import Medal
from kit.school.game.players_histogram import HistogramBin
from kit.school.game.shared_answers import share_answer
from kit.school.progress import EventKind, ProgressError, ProgressJournal
from kit.tui.flourish import Flourish
from kit.tui.rows.challenge_rows import (
    answers_needed_rows,
    beside_others,
    challenge_page,
    challenge_standing,
    judged,
    lesson_below,
)
from kit.tui.rows.key_rows import FOOTER_ROWS, bindings
from kit.tui.rows.lesson_rows import checking
from kit.tui.rows.medal_rows import medal_drawing, medal_size
from kit.tui.screens.dialogs import HelpDialog, MessageDialog
from kit.tui.screens.file_editor import EditsFile, edit_file
from kit.tui.screens.level_pictures import task_picture
from kit.tui.screens.picker import Picker, PickerItem
from kit.tui.screens.text_screen import TextScreen
from kit.tui.widgets.program_colours import LANGUAGES, coloured_rows
from kit.tui.widgets.text_rows import TextRows
from kit.workspace import Workspace
from kit.world.problems import WorldError

if TYPE_CHECKING:
    from kit.tui.theme import Theme

WIDE: Final = 118
"""Columns from which on something stands beside the text."""
COLUMN: Final = 80
"""Columns of the text there; on a screen of less than twice as many, as many as it takes."""
GAP: Final = 2
LEAST_BESIDE: Final = 54
"""Columns without which it stands below the text."""
POLL_S: Final = 0.2
"""Between two looks at the answer's file and at the check [s]."""
NO_RUNS: Final = (
    "No agent has been trained yet. `kit train turn` trains one; on the start screen 5 opens Train."
)


class ChallengeScreen(EditsFile, TextScreen, inherit_bindings=False):
    """Shows a challenge and checks its answer, on a key and whenever the file is saved."""

    has_beside: ClassVar[bool] = True
    """Whether what the answer is about stands beside the page, where there is room."""
    screen_actions = ScreenActions(
        "challenge", ("check", "edit_file", "next", "help", "back"), ("editor", "scroll")
    )
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)
    DEFAULT_CSS = """
    ChallengeScreen #result { height: 0; }
    """

    def __init__(
        self,
        theme: Theme,
        challenge: Challenge,
        journal: ProgressJournal,
        workspace: Workspace,
        following: str | None = None,
    ) -> None:
        """``following``: the title of the next challenge. Raises ProgressError and OSError."""
        super().__init__(challenge.title, ())
        self._theme = theme
        self._glyphs = theme.terminal.glyphs.value
        self._challenge = challenge
        self._progress = journal
        self._workspace = workspace
        self._following = following
        self._file, seconds = self._prepare()
        self._clock_began_at = time.monotonic() - seconds
        self._watch = None if self._file is None else FileWatcher(self._file)
        self._beside: tuple[Row, ...] = ()
        """What the answer is about, beside the page."""
        self._result: list[Row] = []
        self._won = Medal.NONE
        """The medal that was just won, which is drawn where there is room."""
        self._flourish = Flourish(theme, self._renew)
        self._bins: tuple[HistogramBin, ...] = ()
        """How many players of this machine needed how much."""
        self._doing = ""
        self._started_at: float | None = None
        """When the running check was started; None while none is."""
        self._is_left = threading.Event()
        self.wish: Literal["next", "back"] = "back"

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        yield TextRows(id="body", opens=False)  # a board's cursor is no entry of a list
        yield TextRows(id="result")
        yield TextRows(id="keys")

    def on_mount(self) -> None:
        self.set_interval(POLL_S, self._poll)

    def on_unmount(self) -> None:
        self._is_left.set()

    def on_resize(self, event: events.Resize) -> None:
        self._rows = tuple(self._page(event.size.width))
        if self.has_beside:
            self._draw_beside()
        # Textual calls the inherited handler after this one.

    def _page(self, width: int) -> list[Row]:
        """What the challenge asks for, in rows of at most ``width`` columns; on a large screen the checks so far and the lesson that
        teaches it too."""
        if width < WIDE:
            return challenge_page(self._challenge, self._file, width)
        if width < 2 * COLUMN:
            return challenge_page(self._challenge, self._file, width - LEAST_BESIDE - GAP)
        page = challenge_page(self._challenge, self._file, COLUMN - GAP)
        checks = challenge_events(self._progress, self._challenge)
        standing = challenge_standing(self._challenge, checks, COLUMN - GAP)
        room = self.app.size.height - len(page) - self._rows_below - FOOTER_ROWS - 1 - len(standing)
        if room < 0:
            return page
        return [*page, *standing, *lesson_below(self._challenge, COLUMN - GAP, room)]

    def _arranged(self, width: int, height: int) -> list[Row]:
        column = COLUMN if width >= 2 * COLUMN else max(map(row_width, self._rows), default=0) + GAP
        if not self._beside or column + LEAST_BESIDE > width:
            return [*self._rows, *self._beside]
        right = [each for parts in self._beside for each in broken(parts, width - column)]
        return side_by_side(self._rows, right, column)

    @work(exclusive=True, group="beside")
    async def _draw_beside(self) -> None:
        """Shows what the answer is about beside the page, where there is room."""
        width, height = self.size.width, self.size.height
        shown = await to_thread(self._beside_page, width - COLUMN, height - 5) if width >= WIDE else []
        self._beside = tuple(shown)
        self._renew()

    def _beside_page(self, columns: int, rows: int) -> list[Row]:
        """The file that is to be handed in, or the map of the task that is to be trained."""
        if self._file is not None:
            lines = self._file.read_text(errors="replace").splitlines() if self._file.is_file() else []
            return [row(), *coloured_rows(lines, LANGUAGES.get(self._file.suffix))]
        return [row(), *task_picture(self._challenge.task.learning_task, columns, rows, self._glyphs)]

    def _renew(self) -> None:
        """The page has changed."""
        self._rows, self._width = tuple(self._page(self.size.width)), 0
        self._show()

    def on_key(self, event: events.Key) -> None:
        """Any key ends the flourish of a medal."""
        if self._flourish.number:
            self._flourish.end()
            self._renew()

    # What is shown

    def _show(self) -> None:
        if self.query(TextRows):  # not where the kit is left meanwhile
            self.query_one("#result", TextRows).show_all(self._result_rows())
            super()._show()

    @property
    def _rows_below(self) -> int:
        return len(self._result_rows())

    def _result_rows(self) -> list[Row]:
        if self._started_at is not None:
            return [checking(time.monotonic() - self._started_at, self._doing, self.size.width)]
        told = (each for parts in self._result for each in broken(parts, self.size.width))
        return [*self._drawing, *told]

    @property
    def _drawing(self) -> list[Row]:
        return medal_drawing(self._won, medal_size(self.size.height), self._flourish.number)

    @property
    def unavailable_actions(self) -> list[str]:
        return [
            *super().unavailable_actions,
            *(["edit_file", "editor"] if self._file is None else []),
            *(["next"] if self._following is None else []),
        ]

    # The check

    def _poll(self) -> None:
        if self._challenge.task.clock is not None:
            gold_s, silver_s = self._challenge.task.clock
            seconds = time.monotonic() - self._clock_began_at
            medals = f"gold until {gold_s:.0f} s, silver until {silver_s:.0f} s"
            self._title = f"{self._challenge.title}   {seconds:.0f} s; {medals}"
            self._show()
        if self._started_at is not None:
            self._show()
        elif self.is_active and self._watch is not None and self._watch.has_changed():
            self._file_was_saved()

    def _file_was_saved(self) -> None:
        self._draw_beside()
        self.action_check()

    @work(exclusive=True, group="check")
    async def action_check(self) -> None:
        if self._started_at is not None:
            return
        answer = await self._choose_run() if self._file is None else ""
        if answer is None:
            return
        self._prepare_check()
        self._doing, self._started_at = "", time.monotonic()
        self._show()
        try:
            judgement, previous = await to_thread(self._judge, answer)
            self._tell(judgement, previous)
            self._won = judgement.medal if judgement.medal > previous else Medal.NONE
            if self._won:
                self._flourish.begin(self)
        except (AnswerError, WorldError, ProgressError, OSError) as error:
            self._won = Medal.NONE
            self._tell_problem(str(error))
        finally:
            self._started_at = None
        self._renew()

    def _tell(self, judgement: Judgement, previous: Medal) -> None:
        """Says what an answer earned. ``previous``: the best medal before."""
        width = self.size.width
        beside = beside_others(judgement, width)
        self._result = judged(judgement, previous, self._following, beside)
        if judgement.comparison is not None:
            self._result += answers_needed_rows(self._bins, judgement.comparison, width)

    def _tell_problem(self, problem: str) -> None:
        """Says why an answer was not judged."""
        self._result = [row((" No medal", "bold")), row(f" {problem}")]

    def _prepare_check(self) -> None:
        """What is to be done before an answer is checked."""

    def _judge(self, run: str) -> tuple[Judgement, Medal]:
        """Judges the answer, in a thread. Also returns the best medal before. ``run``: the training's name, where that is the answer."""
        file, seconds = self._prepare()
        answer = run if file is None else self._challenge.task.read_answer(file)
        submission = AnswerSubmission(answer, self._workspace.runs, seconds, self._note_progress)
        judgement = self._challenge.task.judge(submission)
        medals = challenge_medals(self._progress.events(EventKind.FINISH))
        record_judgement(self._progress, self._challenge, judgement)
        self._bins = share_answer(self._challenge, answer, judgement)
        return judgement, medals.get(self._challenge.id, Medal.NONE)

    def _prepare(self) -> tuple[Path | None, float]:
        return prepare_answer(self._progress, self._challenge, answers_folder(self._workspace))

    def _note_progress(self, progress: str) -> None:
        if self._is_left.is_set():  # nobody waits for it any more: the check ends
            raise AnswerError("The puzzle was left during its check.")
        self._doing = progress

    async def _choose_run(self) -> str | None:

        runs = [run.name for run in await to_thread(list_runs, self._workspace.runs)]
        if not runs:
            self.app.push_screen(MessageDialog("Agents", NO_RUNS))
            return None
        items = [PickerItem(name, name) for name in runs]
        return await self.app.push_screen_wait(Picker("Which run is handed in?", items))

    # Keys

    def edit(self, *, is_here: bool) -> None:
        """Opens the answer's file; what was saved is checked."""
        if self._file is not None and self._started_at is None:
            edit_file(self.app, self._file, self._theme.terminal, lambda: None, is_here=is_here)

    def action_next(self) -> None:
        if self._following is not None:
            self.wish = "next"
            self.dismiss()

    def action_help(self) -> None:
        self.app.push_screen(HelpDialog("A puzzle", self.screen_actions, without=self.unavailable_actions))
