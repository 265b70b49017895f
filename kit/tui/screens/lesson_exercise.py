"""The exercise of a lesson's step as a widget: which file is changed, how the check stands, and what its keys do.

The defence of a program: what will it do from here? Three answers first, and then the run is seen.
"""

from __future__ import annotations

import re
from asyncio import to_thread
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Final

from textual import events, work
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Container

from kit.dialogue.actions import ScreenAction, ScreenActions, digits
from kit.document.rows import Row, row, spread
from kit.run.scenario import Scenario, find_scenario
from kit.school.lessons.checking import ExerciseFilesError
from kit.school.lessons.defence import Defence, DefenceError
from kit.school.lessons.lesson_session import LessonSession
from kit.school.lessons.records import Exercise, LessonScene, LessonStep
from kit.school.lessons.shell_lines import shell_path
from kit.school.lessons.training_curves import CURVE_ROWS, ROOMY_CURVE_ROWS
from kit.school.progress import ProgressError
from kit.tui.exercise_model import ExerciseModel
from kit.tui.rows import lesson_rows
from kit.tui.rows.key_rows import bindings, footer, key_row
from kit.tui.rows.quiz_rows import defence_rows
from kit.tui.screens.dialogs import MessageDialog, TextScreen, wrapped
from kit.tui.suspend import edit_aside
from kit.tui.textual_patches import ActivePaintScreen
from kit.tui.theme import Theme
from kit.tui.widgets.lesson_page import LessonContent, LessonSceneView
from kit.tui.widgets.text_rows import TextRows
from kit.tui.widgets.world_view import ErrorEvent
from kit.workspace import Workspace

if TYPE_CHECKING:
    from kit.run.recording import Recording


CONFIRM_KEYS: Final = key_row(("Enter", "start over; your files are kept"), ("any other key", "no"))
MOST_DRAWN: Final = 10
"""Rows of a picture of a check that is shown at once, as many as a step's own has; `w` shows longer ones."""
EXERCISE_IDS: Final = (
    "check",
    "edit_file",
    "drive",
    "hint",
    "replay",
    "output",
    "solution",
    "defend",
    "start_over",
)
CHECKING_IDS: Final = frozenset(("next", "previous", "back"))
"""Actions that are possible during a check; each ends it."""


@dataclass(frozen=True, slots=True)
class ExerciseListener:
    """The callbacks by which an exercise informs the screen around it."""

    changed: Callable[[], None]
    """Something that is shown is another."""
    checked: Callable[[], None]
    """There is a verdict, or a hint, to be brought into sight."""
    passed: Callable[[Recording, Scenario], None]
    """A run of a work that has passed, and where it went."""
    failed: Callable[[str, str], None]
    """Title and text of what went wrong."""


class ExercisePanel(Container):
    """Shows the file and the status of the step's exercise, and acts on it; ``model`` is None where the step has none."""

    DEFAULT_CSS = """
    ExercisePanel { height: auto; }
    ExercisePanel > TextRows { height: auto; }
    """

    def __init__(self, theme: Theme, workspace: Workspace, listener: ExerciseListener) -> None:
        super().__init__()
        self.model: ExerciseModel | None = None
        self._theme = theme
        self._workspace = workspace
        self._listener = listener
        self._driven_scene: LessonScene | None = None
        """What is driven, where the exercise is a drive."""
        self._confirming = False
        """Whether it is asked if the exercise is to be begun again."""
        self._notice: Row | None = None
        """Shown instead of the status, or of the keys in a step without an exercise, until the next key."""

    def compose(self) -> ComposeResult:
        yield TextRows(id="file")
        yield TextRows(id="exercise-status")

    def on_unmount(self) -> None:
        self.close()

    def enter(self, session: LessonSession, step: LessonStep) -> None:
        """Lays out the exercise of another step, if that has one."""
        self.close()
        self._driven_scene = step.scene
        if step.exercise is not None:
            try:
                self.model = ExerciseModel(session, step.exercise)
            except ExerciseFilesError as error:
                self._listener.failed("The exercise files cannot be created", str(error))

    def close(self) -> None:
        """Leaves the exercise; a check that is running ends."""
        if self.model is not None:
            self.model.close()
            self.model = None

    # What is shown of it

    def show(self, width: int) -> int:
        """Shows it as it stands now; returns on how many rows."""
        model = self.model
        file = (
            lesson_rows.file_rows(shell_path(model.edited_file), model.by_hand, model.has_others, width)
            if model
            else []
        )
        status = [self._status(model)] if model is not None else []
        self.query_one("#file", TextRows).show_all(file)
        self.query_one("#exercise-status", TextRows).show_all(status)
        return len(file) + len(status)

    def work_picture(self, width: int, *, is_roomy: bool = False) -> list[str]:
        """What the student's work does, in characters: the curves of its trainings as they grow, and the robot with the newest
        policy (where motion is reduced, once they are whole), or what a check drew of it, such as the way of a perfect learner."""
        model = self.model
        if model is None or (model.seconds is not None and self._theme.terminal.reduce_motion.value):
            return []
        curves = model.training_curves
        if curves is not None:
            rows = ROOMY_CURVE_ROWS if is_roomy else CURVE_ROWS
            return curves.picture(width, self._theme.encoder, *model.training_drive(), rows)
        drawn = [] if model.seconds is not None else [line[:width] for line in _picture_lines(model)]
        return drawn if len(drawn) <= MOST_DRAWN else []

    def with_work(self, content: LessonContent) -> LessonContent:
        """Adds the file that is edited and what the program printed, for a screen that has room for them."""
        model = self.model
        if model is None or model.by_hand:
            return content
        lines = model.edited_lines()
        width = len(str(len(lines)))
        rows = [row((f"{number:>{width}} ", "dim"), line) for number, line in enumerate(lines, 1)]
        log = [row("  ", line) for line in _log_lines(model)]
        return replace(
            content,
            file=rows,
            file_title=model.edited_file.name,
            file_line=max(_error_line(model), model.changed_line) - 1,
            log=log,
        )

    def _status(self, model: ExerciseModel) -> Row:
        """One row: where one is with the exercise."""
        if self._confirming:
            return row((" Start this exercise over? Your files are kept beside it.", "warn"))
        if model.seconds is not None:
            return lesson_rows.checking(model.seconds, model.progress)
        return self._notice or lesson_rows.status(
            model.report, model.session.lesson_progress, model.exercise, model.by_hand
        )

    def busy_keys(self, actions: ScreenActions, width: int) -> Row | None:
        """The row of keys while the exercise has them all for itself; else None."""
        if self._confirming:
            return CONFIRM_KEYS
        if not self._is_checking:
            return None
        without = set(actions.footer) - CHECKING_IDS
        return footer(actions, width, without=without, labels={"back": "back; each of these ends the check"})

    def possible_actions(self) -> dict[str, bool]:
        """Which of its actions do something now, by id."""
        model = self.model
        if model is None:
            return dict.fromkeys(EXERCISE_IDS, False)
        report = model.report
        return {
            "check": model.has_driven,
            "edit_file": not model.by_hand,
            "drive": model.by_hand,
            "hint": report is not None and any(each.hints for each in report.lost_criteria),
            "replay": model.recorded_run is not None or bool(_picture_lines(model)),
            "output": bool(_log_lines(model)),
            "solution": model.session.can_see_solution(model.exercise),
            "defend": model.session.can_defend(model.exercise),
            "start_over": True,
        }

    def poll(self) -> None:
        """A few times a second: was the file saved, has the check ended?"""
        model = self.model
        was_checking = self._is_checking
        if model is None or not (self.screen.is_active or was_checking):
            return
        is_read_anew = model.reads_anew()
        try:
            ended = model.poll()
        except ProgressError as error:
            self._listener.failed("This check could not be saved", str(error))
            ended = True
        if ended:
            self._notice = None
            self._listener.checked()
            if model.report is not None and model.report.is_passed and model.report.recording is not None:
                self._show_run(model, model.report.recording)
        elif self._is_checking or was_checking or is_read_anew:
            self._listener.changed()

    @property
    def _is_checking(self) -> bool:
        return self.model is not None and self.model.seconds is not None

    @property
    def _idle_model(self) -> ExerciseModel | None:
        """The exercise, where a key may do something with it now."""
        self._notice = None
        return None if self._is_checking or self._confirming else self.model

    @work(exclusive=True)
    async def _show_run(self, model: ExerciseModel, file: Path) -> None:
        """Hands the screen the run that passed."""
        try:
            recording, place = await to_thread(_load, file)
        except Exception:  # noqa: BLE001 - a pass is a pass, whatever the world or the disk does to its picture
            return
        if self.model is model:
            self._listener.passed(recording, place)

    # Keys

    def check(self) -> None:
        model = self._idle_model
        if model is not None and not model.has_driven:
            self.notify_row(" You have not driven yet: press d.")
        elif model is not None:
            model.start()
            self._listener.changed()

    def edit_file(self) -> None:
        """Opens the student's file at the line of the first error, else at the first TODO, and checks what was saved."""
        model = self._idle_model
        if model is None or model.by_hand:
            return
        problem = edit_aside(self.app, model.edited_file, line_to_edit(model), self._theme.terminal)
        if problem:
            self._listener.failed("No editor opened", problem)
        self.poll()

    def hint(self) -> None:
        model = self._idle_model
        if model is None:
            return
        try:
            hint = model.session.next_hint(model.exercise)
        except ProgressError as error:
            self._listener.failed("This hint could not be saved", str(error))
            return
        if hint is None:
            self.notify_row(_no_hint_text(model, bool(model.session.opened_hints(model.exercise))))
        self._listener.checked()

    def output(self) -> None:
        model = self._idle_model
        if model is None:
            return
        if not (lines := _log_lines(model)):
            self.notify_row(
                " Your program printed nothing."
                if model.report is not None
                else " Your program has not run yet: c checks it."
            )
            self._listener.changed()
        else:
            self.app.push_screen(TextScreen("What your program printed", [row(line) for line in lines]))

    def solution(self) -> None:
        model = self._idle_model
        if model is None:
            return
        try:
            files = model.session.open_solution(model.exercise)
        except ProgressError as error:
            self._listener.failed("This could not be saved", str(error))
            return
        if not files:
            passed = model.session.can_see_solution(model.exercise)
            self.notify_row(
                " No solution came with this kit." if passed else " The solution is shown once yours passes."
            )
            self._listener.changed()
            return
        rows = []
        for name, text in files.items():
            rows += [
                *([row((f"--- {name}", "bold"))] if len(files) > 1 else []),
                *map(row, text.expandtabs(4).splitlines()),
            ]
        self.app.push_screen(TextScreen(f"Reference solution: {next(iter(files))}", rows))

    def start_over(self) -> None:
        if self._idle_model is not None:
            self._confirming = True
            self._listener.changed()

    def confirm_start_over(self) -> bool:
        """Starts the exercise over if that was asked; returns whether it was."""
        if not self._confirming or self.model is None:
            return False
        self._confirming = False
        try:
            kept = self.model.start_over()
        except ExerciseFilesError as error:
            self._listener.failed("The exercise was not started over", str(error))
        else:
            self.notify_row(
                f" Started over. Your files are kept in {kept.name}, beside it." if kept else " Started over."
            )
        self._listener.changed()
        return True

    def cancel_start_over(self) -> bool:
        """Takes a key as no if it was asked whether to start over; returns whether it was."""
        asked, self._confirming = self._confirming, False
        if asked:
            self._listener.changed()
        return asked

    @work
    async def replay(self) -> None:
        model = self._idle_model
        if model is None:
            return
        pictures = [row(line) for line in _picture_lines(model)]
        file = model.recorded_run
        if file is None:
            if pictures:
                self.app.push_screen(TextScreen("What went wrong", pictures))
            return
        try:
            recording, place = await to_thread(_load, file)
        except Exception as error:  # noqa: BLE001 - a recording, a world or a disk that is not as it should be
            if pictures:
                self.app.push_screen(TextScreen("What went wrong", pictures))
                return
            self._listener.failed("The run cannot be replayed", str(error))
            return
        from kit.tui.screens.lesson_drive import RecordingScreen  # of no use to the first frame

        await self.app.push_screen_wait(RecordingScreen(self._theme, place, recording, "your last run"))

    @work
    async def drive(self) -> None:
        model, scene = self._idle_model, self._driven_scene
        if model is None or not model.by_hand or scene is None:
            return
        from kit.tui.screens.lesson_drive import RecordedDriveScreen  # of no use to the first frame

        drive = RecordedDriveScreen(self._theme, scene, model.file, self._workspace)
        await self.app.push_screen_wait(drive)
        if drive.problem:
            self._listener.failed("The drive could not be saved", drive.problem)
        elif drive.was_kept and self.model is model:
            model.start()
        self._listener.changed()

    @property
    def step_notice(self) -> Row | None:
        """What is said in a step without an exercise, until the next key."""
        return self._notice if self.model is None else None

    def drop_step_notice(self) -> None:
        """Takes back what was said in a step without an exercise: the next key has been pressed."""
        if self.model is None and self._notice is not None:
            self._notice = None
            self._listener.changed()

    @work
    async def defend(self) -> None:
        model = self._idle_model
        if model is None or not model.session.can_defend(model.exercise):
            return

        await self.app.push_screen_wait(
            DefenceScreen(self._theme, model.session, model.exercise, self._workspace)
        )
        self._listener.changed()

    def notify_row(self, text: str, style: str = "") -> None:
        """Shows a row instead of the status, or beside the title in a step without an exercise, until the next key."""
        self._notice = row((text, style))
        self._listener.changed()


def _load(file: Path) -> tuple[Recording, Scenario]:
    """Loads a recording and its scenario, in another thread: the physics takes a moment to import."""
    from kit.run.recording import load_recording

    recording = load_recording(file)
    return recording, find_scenario(recording.place, recording.case)


def _log_lines(model: ExerciseModel) -> list[str]:
    criteria = model.report.criteria if model.report is not None else ()
    logs = dict.fromkeys(each.log for each in criteria if each.log.strip())
    return [line for log in logs for line in log.expandtabs(4).splitlines()]


def _picture_lines(model: ExerciseModel) -> list[str]:
    lost = model.report.lost_criteria if model.report is not None else ()
    picture = next((each.replay for each in lost if each.replay), "")
    return picture.splitlines()


def line_to_edit(model: ExerciseModel) -> int:
    """The line of the edited file to begin at, counted from 1: the one that the last check's first error names; else that
    of the first TODO that is left; else the first."""
    return _error_line(model) or model.first_todo()


def _error_line(model: ExerciseModel) -> int:
    """The line of the edited file that the last check's first error names; 0 if it names none."""
    report = model.report
    texts = [] if report is None else [report.problem, *(each.rationale for each in report.lost_criteria)]
    name = re.escape(model.edited_file.name)
    found = next((match for text in texts if (match := re.search(rf"\b{name}:(\d+)", text))), None)
    return 0 if found is None else int(found[1])


def _no_hint_text(model: ExerciseModel, opened: bool) -> str:
    if opened:
        return " You have seen all hints for this criterion."
    if model.report is None:
        return " Check first (c): hints are for criteria that you missed."
    return " Nothing was missed." if model.report.is_passed else " There is no hint for this."


class DefenceScreen(ActivePaintScreen[None]):
    """Asks about the student's own program, and shows the run once every question is answered."""

    AUTO_FOCUS = ""
    screen_actions = ScreenActions(
        "defence",
        ("defence_answer", "restart", "back"),
        own=(
            ScreenAction("defence_answer", "1 2 3", "answer", "choose an answer; it counts", digits("answer", 1, 3), "1-3"),
        ),
    )  # fmt: skip
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)
    DEFAULT_CSS = """
    DefenceScreen { layout: vertical; }
    DefenceScreen #heading, DefenceScreen #keys { height: 1; }
    DefenceScreen #words { height: auto; }
    """

    def __init__(
        self, theme: Theme, session: LessonSession, exercise: Exercise, workspace: Workspace
    ) -> None:
        super().__init__()
        self._session = session
        self._exercise = exercise
        self._scene = LessonSceneView(theme, workspace.controllers)
        self._defence: Defence | None = None
        self._answers: list[int] = []

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        yield self._scene
        yield TextRows(id="words")
        yield TextRows(id="keys")

    def on_mount(self) -> None:
        self._prepare()

    def on_resize(self, event: events.Resize) -> None:
        self.call_after_refresh(self._show)

    @work
    async def _prepare(self) -> None:
        try:
            self._defence = await to_thread(self._session.prepare_defence, self._exercise)
        except DefenceError as error:
            await self.app.push_screen_wait(MessageDialog("There is nothing to ask", wrapped(str(error))))
            self.dismiss()
            return
        if self.is_mounted:
            self._scene.play(self._defence.recording, self._defence.place, still=True)
            self._show()

    @property
    def _is_answered(self) -> bool:
        return self._defence is not None and len(self._answers) == len(self._defence.questions)

    def _show(self) -> None:
        if not self.size.width or not self.is_mounted:
            return
        width, defence = self.size.width, self._defence
        caption = self._scene.caption if self._is_answered and not self._scene.is_resting else ""
        title = row(("Defend your program: ", "dim"), (self._exercise.name, "bold"))
        self.query_one("#heading", TextRows).show([spread(title, row((caption, "dim")), width)])
        words = (
            [row(("  Running your program once, off screen, from a new start ...", "bold"))]
            if defence is None
            else defence_rows(defence, self._answers, width)
        )
        self.query_one("#words", TextRows).show_all(words)
        without: tuple[str, ...] = ("restart",) if not self._is_answered else ("defence_answer",)
        if defence is None:  # there is nothing to answer yet
            without = ("restart", "defence_answer")
        count = (
            0 if defence is None or self._is_answered else len(defence.questions[len(self._answers)].options)
        )
        keys = {"defence_answer": f"1-{count}"} if count else {}
        self.query_one("#keys", TextRows).show(
            [footer(self.screen_actions, width, without=without, keys=keys)]
        )

    def on_lesson_scene_view_moved(self) -> None:
        self._show()

    def on_error_event(self, event: ErrorEvent) -> None:
        self.app.push_screen(MessageDialog("The run cannot be shown", wrapped(event.text)))

    def action_answer(self, number: int) -> None:
        defence = self._defence
        if defence is None or self._is_answered:
            return
        if number > len(defence.questions[len(self._answers)].options):
            return
        self._answers.append(number - 1)
        if self._is_answered:
            try:
                self._session.record_defence(self._exercise, defence, self._answers)
            except ProgressError as error:
                self.app.push_screen(MessageDialog("This could not be saved", wrapped(str(error))))
            self._scene.go()
        self._show()

    def action_restart(self) -> None:
        """The run once more."""
        if self._is_answered:
            self._scene.again()

    def action_back(self) -> None:
        self.dismiss()
