"""The actions of an exercise in a lesson: check, hint, replay, output, solution, start over, drive."""

from __future__ import annotations

import re
from asyncio import to_thread
from pathlib import Path
from typing import TYPE_CHECKING, Final

from textual import work
from textual.screen import Screen

from kit.school.lessons.exercise_files import ExerciseFilesError
from kit.school.progress import ProgressError
from kit.tui.actions import SCREENS
from kit.tui.rows import lesson_rows
from kit.tui.rows.key_rows import footer, key_row
from kit.tui.screens.text_screen import TextScreen
from kit.tui.suspend import edit_aside
from kit.tui.widgets.text_rows import Row, row

if TYPE_CHECKING:
    from kit.run.recording import Recording
    from kit.run.scenario import Scenario
    from kit.school.lessons.lesson_session import LessonSession
    from kit.school.lessons.records import LessonStep
    from kit.tui.exercise_model import ExerciseModel
    from kit.tui.theme import Theme
    from kit.workspace import Workspace


CONFIRM_KEYS: Final = key_row(("Enter", "start over; your files are kept"), ("any other key", "no"))
EXERCISE_IDS: Final = ("check", "edit_file", "drive", "hint", "replay", "output", "solution", "start_over")
CHECKING_IDS: Final = frozenset(("next", "previous", "back"))
"""Actions that are possible during a check; each ends it."""


class ExerciseActions(Screen[None]):
    """The part of the lesson screen that acts on the step's exercise; ``model`` is None where the step has none."""

    theme: Theme
    visit: LessonSession
    workspace: Workspace
    step: LessonStep
    model: ExerciseModel | None

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
            return row((" Start this exercise over? Your files are kept beside it.", "warn"))
        if model.seconds is not None:
            return lesson_rows.checking(model.seconds, model.progress)
        return self._notice or lesson_rows.status(
            model.report, self.visit.lesson_progress, self.step, model.by_hand
        )

    def busy_keys(self) -> Row | None:
        """The row of keys while the exercise has them all for itself; else None."""
        if self._confirming:
            return CONFIRM_KEYS
        if self.model is None and self._notice is not None:
            return self._notice
        if not self._is_checking:
            return None
        without = set(SCREENS["lesson"].footer) - CHECKING_IDS
        return footer(
            "lesson", self.size.width, without=without, labels={"back": "back; each of these ends the check"}
        )

    def exercise_actions(self) -> dict[str, bool]:
        """Which of its actions do something now, by id."""
        model = self.model
        if model is None:
            return dict.fromkeys(EXERCISE_IDS, False)
        report = model.report
        return {
            "check": True,
            "edit_file": not model.by_hand,
            "drive": model.by_hand,
            "hint": report is not None and any(each.hints for each in report.lost_criteria),
            "replay": report is not None and (report.recording is not None or bool(_picture_lines(model))),
            "output": bool(_log_lines(model)),
            "solution": self.visit.can_see_solution(model.exercise),
            "start_over": True,
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
            self.show_error("This check could not be saved", str(error))
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

    def action_edit_file(self) -> None:
        """Opens the student's file at the line of the first error, and checks what was saved."""
        model = self._idle_model
        if model is None or model.by_hand:
            return
        problem = edit_aside(self.app, model.edited_file, _error_line(model), self.theme.terminal)
        if problem:
            self.show_error("No editor opened", problem)
        self.poll_exercise()

    def action_hint(self) -> None:
        model = self._idle_model
        if model is None:
            return
        try:
            hint = self.visit.next_hint(model.exercise)
        except ProgressError as error:
            self.show_error("This hint could not be saved", str(error))
            return
        if hint is None:
            self.notify_row(_no_hint_text(model, bool(self.visit.opened_hints(model.exercise))))
        self.show_answer()

    def action_output(self) -> None:
        model = self._idle_model
        if model is None:
            return
        if not (lines := _log_lines(model)):
            self.notify_row(
                " Your program printed nothing."
                if model.report is not None
                else " Your program has not run yet: c checks it."
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
            self.show_error("This could not be saved", str(error))
            return
        if not files:
            passed = self.visit.can_see_solution(model.exercise)
            self.notify_row(
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
        self.app.push_screen(TextScreen(f"Reference solution: {next(iter(files))}", rows))

    def action_start_over(self) -> None:
        if self._idle_model is not None:
            self._confirming = True
            self.show()

    def confirm_start_over(self) -> bool:
        """Starts the exercise over if that was asked; returns whether it was."""
        if not self._confirming or self.model is None:
            return False
        self._confirming = False
        try:
            kept = self.model.start_over()
        except ExerciseFilesError as error:
            self.show_error("The exercise was not started over", str(error))
        else:
            self.notify_row(
                f" Started over. Your files are kept in {kept.name}, beside it." if kept else " Started over."
            )
        self.show()
        return True

    def cancel_start_over(self) -> bool:
        """Takes a key as no if it was asked whether to start over; returns whether it was."""
        asked, self._confirming = self._confirming, False
        if asked:
            self.show()
        return asked

    @work
    async def action_replay(self) -> None:
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
            self.show_error("The run cannot be replayed", str(error))
            return
        from kit.tui.screens.lesson_drive import RecordingScreen  # of no use to the first frame

        await self.app.push_screen_wait(RecordingScreen(self.theme, place, recording, "your last run"))

    @work
    async def action_drive(self) -> None:
        model, scene = self._idle_model, self.step.scene
        if model is None or not model.by_hand or scene is None:
            return
        from kit.tui.screens.lesson_drive import RecordedDriveScreen  # of no use to the first frame

        drive = RecordedDriveScreen(self.theme, scene, model.file, self.workspace)
        await self.app.push_screen_wait(drive)
        if drive.problem:
            self.show_error("The drive could not be saved", drive.problem)
        elif drive.was_kept and self.model is model:
            model.start()
        self.show()

    def notify_row(self, text: str) -> None:
        """Shows a row instead of the status, or of the keys in a step without an exercise, until the next key."""
        self._notice = row(text)
        self.show()


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


def _error_line(model: ExerciseModel) -> int:
    """The line of the edited file that the last check's first error names; 1 if it names none."""
    report = model.report
    texts = [] if report is None else [report.problem, *(each.rationale for each in report.lost_criteria)]
    name = re.escape(model.edited_file.name)
    found = next((match for text in texts if (match := re.search(rf"\b{name}:(\d+)", text))), None)
    return 1 if found is None else int(found[1])


def _no_hint_text(model: ExerciseModel, opened: bool) -> str:
    if opened:
        return " You have seen all hints for this criterion."
    if model.report is None:
        return " Check first (c): a hint is for a criterion that was missed."
    return " Nothing was missed." if model.report.is_passed else " There is no hint for this."
