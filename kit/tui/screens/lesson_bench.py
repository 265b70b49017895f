"""The keys of an exercise: check, hint, what went wrong, solution, begin again, drive."""

from __future__ import annotations

from asyncio import to_thread
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from textual import work
from textual.binding import Binding, BindingType
from textual.screen import Screen

from kit.school.lessons.exercise_files import WorkError
from kit.school.progress import ProgressError
from kit.tui.rows import lesson_rows as say
from kit.tui.screens.lesson_keys import ASK_BEGIN_AGAIN, CHECKING_KEYS
from kit.tui.screens.scroll_page import ScrollPage
from kit.tui.widgets.text_rows import Row, row

if TYPE_CHECKING:
    from kit.run.recording import Recording
    from kit.run.scenario import Place
    from kit.school.lessons.lesson_session import Visit
    from kit.school.lessons.records import Step
    from kit.tui.exercise_model import Workbench
    from kit.tui.theme import Look
    from kit.workspace import Workspace


class BenchKeys(Screen[None]):
    """What a lesson's screen does with the exercise of its step; ``bench`` is None where it has none."""

    look: Look
    visit: Visit
    desk: Workspace
    step: Step
    bench: Workbench | None

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

    _asks = False
    """Whether it is asked if the exercise is to be begun again."""
    _remark: Row | None = None
    """Said instead of the status, until the next key."""

    def show(self) -> None:
        """Everything, as it stands now."""
        raise NotImplementedError

    def show_answer(self) -> None:
        """Everything, and the verdict in sight."""
        raise NotImplementedError

    def tell(self, title: str, text: str) -> None:
        """What went wrong, as a page over the step."""
        raise NotImplementedError

    # What is shown of it

    def bench_status(self) -> Row:
        """One row: where one is with the exercise."""
        bench = self.bench
        assert bench is not None
        if self._asks:
            return row((" Begin this exercise anew? What you have is kept beside it.", "warn"))
        if bench.seconds is not None:
            return say.checking(bench.seconds)
        return self._remark or say.status(bench.report, self.visit.standing, self.step, bench.by_hand)

    def asked_keys(self) -> Row | None:
        """The row of keys while the exercise has them all for itself; else None."""
        if self._asks:
            return ASK_BEGIN_AGAIN
        return CHECKING_KEYS if self._is_checking else None

    def bench_possible(self) -> dict[str, bool]:
        """Which of its keys work now, as fields of ``Possible``."""
        bench = self.bench
        if bench is None:
            return {}
        report = bench.report
        return {
            "check": True,
            "drive": bench.by_hand,
            "hint": report is not None and any(each.hints for each in report.lost_criteria),
            "worst": report is not None and (report.recording is not None or bool(_pictures(bench))),
            "printed": bool(_logs(bench)),
            "solution": self.visit.may_see_solution(bench.exercise),
            "begin_again": True,
        }

    def look_at_bench(self) -> None:
        """A few times a second: was the file saved, has the check ended?"""
        bench = self.bench
        was_checking = self._is_checking
        if bench is None or not (self.is_active or was_checking):
            return
        try:
            ended = bench.look()
        except ProgressError as error:
            self.tell("This check could not be noted", str(error))
            ended = True
        if ended:
            self._remark = None
            self.show_answer()
        elif self._is_checking or was_checking:
            self.show()

    @property
    def _is_checking(self) -> bool:
        return self.bench is not None and self.bench.seconds is not None

    @property
    def _free(self) -> Workbench | None:
        """The exercise, where a key may do something with it now."""
        self._remark = None
        return None if self._is_checking or self._asks else self.bench

    # Keys

    def action_check(self) -> None:
        if (bench := self._free) is not None:
            bench.start()
            self.show()

    def action_hint(self) -> None:
        bench = self._free
        if bench is None:
            return
        try:
            hint = self.visit.next_hint(bench.exercise)
        except ProgressError as error:
            self.tell("This hint could not be noted", str(error))
            return
        if hint is None:
            self._say(_no_hint(bench, bool(self.visit.hints(bench.exercise))))
        self.show_answer()

    def action_printed(self) -> None:
        bench = self._free
        if bench is None:
            return
        if not (lines := _logs(bench)):
            self._say(
                " It printed nothing." if bench.report is not None else " Nothing has run yet: r checks."
            )
            self.show()
        else:
            self.app.push_screen(ScrollPage("What your program printed", [row(line) for line in lines]))

    def action_solution(self) -> None:
        bench = self._free
        if bench is None:
            return
        try:
            files = self.visit.solution(bench.exercise)
        except ProgressError as error:
            self.tell("This could not be noted", str(error))
            return
        if not files:
            passed = self.visit.may_see_solution(bench.exercise)
            self._say(
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
        self.app.push_screen(ScrollPage(f"One way to do it: {next(iter(files))}", rows))

    def action_begin_again(self) -> None:
        if self._free is not None:
            self._asks = True
            self.show()

    def action_yes(self) -> None:
        if not self._asks or self.bench is None:
            return
        self._asks = False
        try:
            kept = self.bench.begin_again()
        except WorkError as error:
            self.tell("The exercise stays as it was", str(error))
        else:
            self._say(
                f" As at first. What you had is in {kept.name}, beside it." if kept else " As at first."
            )
        self.show()

    def leave_question(self) -> bool:
        """Takes a key as no, if something was asked."""
        asked, self._asks = self._asks, False
        if asked:
            self.show()
        return asked

    @work
    async def action_worst(self) -> None:
        bench = self._free
        if bench is None or bench.report is None:
            return
        pictures = [row(line) for line in _pictures(bench)]
        if bench.report.recording is None:
            if pictures:
                self.app.push_screen(ScrollPage("What went wrong", pictures))
            return
        try:
            recording, place = await to_thread(_load, bench.report.recording)
        except Exception as error:  # noqa: BLE001 - a recording, a world or a disk that is not as it should be
            if pictures:
                self.app.push_screen(ScrollPage("What went wrong", pictures))
                return
            self.tell("The run cannot be shown", str(error))
            return
        from kit.tui.screens.lesson_drive import WorstRun  # of no use to the first frame

        await self.app.push_screen_wait(WorstRun(self.look, place, recording, "the worst run"))

    @work
    async def action_drive(self) -> None:
        bench, scene = self._free, self.step.scene
        if bench is None or not bench.by_hand or scene is None:
            return
        from kit.tui.screens.lesson_drive import HandDrive  # of no use to the first frame

        drive = HandDrive(self.look, scene, bench.file, self.desk)
        await self.app.push_screen_wait(drive)
        if drive.problem:
            self.tell("The drive could not be kept", drive.problem)
        elif drive.was_kept and self.bench is bench:
            bench.start()
        self.show()

    def _say(self, text: str) -> None:
        self._remark = row(text)


def _load(file: Path) -> tuple[Recording, Place]:
    """In another thread: the physics takes a moment to import."""
    from kit.run.recording import load
    from kit.run.scenario import find_place

    recording = load(file)
    return recording, find_place(recording.place, recording.case)


def _logs(bench: Workbench) -> list[str]:
    criteria = bench.report.criteria if bench.report is not None else ()
    logs = dict.fromkeys(each.log for each in criteria if each.log.strip())
    return [line for log in logs for line in log.expandtabs(4).splitlines()]


def _pictures(bench: Workbench) -> list[str]:
    lost = bench.report.lost_criteria if bench.report is not None else ()
    picture = next((each.replay for each in lost if each.replay), "")
    return picture.splitlines()


def _no_hint(bench: Workbench, opened: bool) -> str:
    if opened:
        return " These are all the hints for it."
    if bench.report is None:
        return " First a check (r): a hint is for what was lost."
    return " Nothing was lost." if bench.report.is_passed else " There is no hint for this."
