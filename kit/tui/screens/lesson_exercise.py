"""The keys of an exercise: check, hint, what went wrong, solution, begin again, drive."""

from __future__ import annotations

from asyncio import to_thread
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from textual import work
from textual.binding import Binding, BindingType
from textual.screen import Screen

from kit.school.lessons.exercise_files import ExerciseFilesError
from kit.school.progress import ProgressError
from kit.tui.rows import lesson_rows
from kit.tui.screens.lesson_keys import ASK_BEGIN_AGAIN, CHECKING_KEYS
from kit.tui.screens.text_screen import TextScreen
from kit.tui.widgets.text_rows import Row, row

if TYPE_CHECKING:
    from kit.run.recording import Recording
    from kit.run.scenario import Scenario
    from kit.school.lessons.lesson_session import LessonSession
    from kit.school.lessons.records import LessonStep
    from kit.tui.exercise_model import ExerciseModel
    from kit.tui.theme import Theme
    from kit.workspace import Workspace


class ExerciseActions(Screen[None]):
    """What a lesson's screen does with the exercise of its step; ``model`` is None where it has none."""

    theme: Theme
    visit: LessonSession
    workspace: Workspace
    step: LessonStep
    model: ExerciseModel | None

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("r", "check", show=False),
        Binding("h", "hint", show=False),
        Binding("w", "worst", show=False),
        Binding("p", "printed", show=False),
        Binding("s", "solution", show=False),
        Binding("x", "begin_again", show=False),
        Binding("y", "yes", show=False),
        Binding("d", "drive", show=False),
    ]

    _confirming = False
    """Whether it is asked if the exercise is to be begun again."""
    _notice: Row | None = None
    """Said instead of the status, until the next key."""

    def show(self) -> None:
        """Everything, as it stands now."""
        raise NotImplementedError

    def show_answer(self) -> None:
        """Everything, and the verdict in sight."""
        raise NotImplementedError

    def show_error(self, title: str, text: str) -> None:
        """What went wrong, as a page over the step."""
        raise NotImplementedError

    # What is shown of it

    def exercise_status(self) -> Row:
        """One row: where one is with the exercise."""
        model = self.model
        assert model is not None
        if self._confirming:
            return row((" Begin this exercise anew? What you have is kept beside it.", "warn"))
        if model.seconds is not None:
            return lesson_rows.checking(model.seconds)
        return self._notice or lesson_rows.status(
            model.report, self.visit.lesson_progress, self.step, model.by_hand
        )

    def asked_keys(self) -> Row | None:
        """The row of keys while the exercise has them all for itself; else None."""
        if self._confirming:
            return ASK_BEGIN_AGAIN
        return CHECKING_KEYS if self._is_checking else None

    def exercise_actions(self) -> dict[str, bool]:
        """Which of its keys work now, as fields of ``Possible``."""
        model = self.model
        if model is None:
            return {}
        report = model.report
        return {
            "check": True,
            "drive": model.by_hand,
            "hint": report is not None and any(each.hints for each in report.lost_criteria),
            "worst": report is not None and (report.recording is not None or bool(_picture_lines(model))),
            "printed": bool(_log_lines(model)),
            "solution": self.visit.can_see_solution(model.exercise),
            "begin_again": True,
        }

    def poll_exercise(self) -> None:
        """A few times a second: was the file saved, has the check ended?"""
        model = self.model
        was_checking = self._is_checking
        if model is None or not (self.is_active or was_checking):
            return
        try:
            ended = model.poll()
        except ProgressError as error:
            self.show_error("This check could not be noted", str(error))
            ended = True
        if ended:
            self._notice = None
            self.show_answer()
        elif self._is_checking or was_checking:
            self.show()

    @property
    def _is_checking(self) -> bool:
        return self.model is not None and self.model.seconds is not None

    @property
    def _idle_model(self) -> ExerciseModel | None:
        """The exercise, where a key may do something with it now."""
        self._notice = None
        return None if self._is_checking or self._confirming else self.model

    # Keys

    def action_check(self) -> None:
        if (model := self._idle_model) is not None:
            model.start()
            self.show()

    def action_hint(self) -> None:
        model = self._idle_model
        if model is None:
            return
        try:
            hint = self.visit.next_hint(model.exercise)
        except ProgressError as error:
            self.show_error("This hint could not be noted", str(error))
            return
        if hint is None:
            self._notify(_no_hint_text(model, bool(self.visit.opened_hints(model.exercise))))
        self.show_answer()

    def action_printed(self) -> None:
        model = self._idle_model
        if model is None:
            return
        if not (lines := _log_lines(model)):
            self._notify(
                " It printed nothing." if model.report is not None else " Nothing has run yet: r checks."
            )
            self.show()
        else:
            self.app.push_screen(TextScreen("What your program printed", [row(line) for line in lines]))

    def action_solution(self) -> None:
        model = self._idle_model
        if model is None:
            return
        try:
            files = self.visit.open_solution(model.exercise)
        except ProgressError as error:
            self.show_error("This could not be noted", str(error))
            return
        if not files:
            passed = self.visit.can_see_solution(model.exercise)
            self._notify(
                " No solution came with this kit." if passed else " The solution is shown once yours passes."
            )
            self.show()
            return
        rows = []
        for name, text in files.items():
            rows += [
                *([row((f"--- {name}", "bold"))] if len(files) > 1 else []),
                *map(row, text.expandtabs(4).splitlines()),
            ]
        self.app.push_screen(TextScreen(f"One way to do it: {next(iter(files))}", rows))

    def action_begin_again(self) -> None:
        if self._idle_model is not None:
            self._confirming = True
            self.show()

    def action_yes(self) -> None:
        if not self._confirming or self.model is None:
            return
        self._confirming = False
        try:
            kept = self.model.start_over()
        except ExerciseFilesError as error:
            self.show_error("The exercise stays as it was", str(error))
        else:
            self._notify(
                f" As at first. What you had is in {kept.name}, beside it." if kept else " As at first."
            )
        self.show()

    def leave_question(self) -> bool:
        """Takes a key as no, if something was asked."""
        asked, self._confirming = self._confirming, False
        if asked:
            self.show()
        return asked

    @work
    async def action_worst(self) -> None:
        model = self._idle_model
        if model is None or model.report is None:
            return
        pictures = [row(line) for line in _picture_lines(model)]
        if model.report.recording is None:
            if pictures:
                self.app.push_screen(TextScreen("What went wrong", pictures))
            return
        try:
            recording, place = await to_thread(_load, model.report.recording)
        except Exception as error:  # noqa: BLE001 - a recording, a world or a disk that is not as it should be
            if pictures:
                self.app.push_screen(TextScreen("What went wrong", pictures))
                return
            self.show_error("The run cannot be shown", str(error))
            return
        from kit.tui.screens.lesson_drive import RecordingScreen  # of no use to the first frame

        await self.app.push_screen_wait(RecordingScreen(self.theme, place, recording, "the worst run"))

    @work
    async def action_drive(self) -> None:
        model, scene = self._idle_model, self.step.scene
        if model is None or not model.by_hand or scene is None:
            return
        from kit.tui.screens.lesson_drive import RecordedDriveScreen  # of no use to the first frame

        drive = RecordedDriveScreen(self.theme, scene, model.file, self.workspace)
        await self.app.push_screen_wait(drive)
        if drive.problem:
            self.show_error("The drive could not be kept", drive.problem)
        elif drive.was_kept and self.model is model:
            model.start()
        self.show()

    def _notify(self, text: str) -> None:
        self._notice = row(text)


def _load(file: Path) -> tuple[Recording, Scenario]:
    """In another thread: the physics takes a moment to import."""
    from kit.run.recording import load_recording
    from kit.run.scenario import find_scenario

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


def _no_hint_text(model: ExerciseModel, opened: bool) -> str:
    if opened:
        return " These are all the hints for it."
    if model.report is None:
        return " First a check (r): a hint is for what was lost."
    return " Nothing was lost." if model.report.is_passed else " There is no hint for this."
