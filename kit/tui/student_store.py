"""The student's data for the start screen: the journal, the current lesson, and the questions due. No Textual."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from kit.workspace import Workspace

if TYPE_CHECKING:  # reading lessons takes a moment to import: the frame is drawn first
    from kit.school.game.levels import GameLevel
    from kit.school.lessons.catalogue import LessonEntry
    from kit.school.lessons.lesson_session import LessonSession
    from kit.school.lessons.records import Lesson
    from kit.school.progress import ProgressEvent, ProgressJournal


@dataclass(frozen=True, slots=True)
class StudentOverview:
    """A student's progress in all parts of the kit."""

    shelf: tuple[LessonEntry, ...] = ()
    going_on: LessonEntry | None = None
    """Where to go on; None: all is done, or there is nothing."""
    due: int | None = None
    """Questions due today; None: they cannot be read."""
    streak: int = 0
    """Days in a row on which the level of the day was finished."""
    has_run_today: bool = False
    """Whether today's run of it has begun."""
    next_medal: str = ""
    """The medal that is nearest to what was driven, and its level; empty where none is in sight."""
    next_level: GameLevel | None = None
    """The first open level without a medal; None where there is none."""
    won: tuple[tuple[str, int, int], ...] = ()
    """Of each world of the game its title, how many of its levels have a medal, and how many it has."""
    running: tuple[str, ...] = ()
    """Names of the trainings that run."""
    news: str = ""
    """What is new on the start screen, where it was read for the first time."""
    problem: str = ""
    """Why progress, or lessons, cannot be read."""
    is_whole: bool = True
    """False while only the lessons have been read."""

    @property
    def done(self) -> int:
        return sum(each.is_completed for each in self.shelf)


class StudentStore:
    """One student's lessons and journal. ``lessons``: another folder than the kit's own."""

    def __init__(self, workspace: Workspace, lessons: Path | None = None) -> None:
        self.workspace = workspace
        self._lessons = lessons
        self._progress: ProgressJournal | None = None
        self._known: StudentOverview | None = None
        """What was read last."""
        self._opening = threading.Lock()

    def progress(self) -> ProgressJournal:
        """The journal, opened when it is first asked for. Raises ProgressError."""
        from kit.school.progress import ProgressJournal

        with self._opening:
            if self._progress is None:
                self._progress = ProgressJournal(self.workspace.folder)
            return self._progress

    def take_notice(self) -> str:
        """Returns the notice on the state in which the journal was found, once; then it is empty."""
        notice = ""
        if self._progress is not None:
            notice, self._progress.notice = self._progress.notice, ""
        return notice

    def read_overview(self, on_part: Callable[[StudentOverview], None] = lambda _: None) -> StudentOverview:
        """Reads everything. Slow: to be called in another thread. ``on_part``: is told where to go on as soon as that is known, a
        third of the way; and before that, where all was read once, what was won since."""
        from kit.school.lessons.catalogue import list_lessons, next_lesson
        from kit.school.news import take_news
        from kit.school.progress import ProgressError

        try:
            events = self.progress().events()
            if self._known is not None:
                next_medal, next_level, won = self._game(events)
                on_part(replace(self._known, next_medal=next_medal, next_level=next_level, won=won))
            shelf = list_lessons(events, self._lessons)
        except (ProgressError, FileNotFoundError) as error:
            return StudentOverview(problem=str(error))
        going_on = next_lesson(shelf)
        from kit.school.game.daily import daily_id, streak, today

        day = today()
        days, has_run = streak(events, day), any(event.subject == daily_id(day) for event in events)
        on_part(StudentOverview(shelf, going_on, streak=days, has_run_today=has_run, is_whole=False))
        next_medal, next_level, won = self._game(events)
        self._known = StudentOverview(
            shelf,
            going_on,
            self._count_due(),
            days,
            has_run,
            next_medal,
            next_level,
            won,
            self._running(),
            take_news(self.progress(), "start"),
        )
        return self._known

    def open_lesson(self, lesson: Lesson) -> LessonSession:
        """Opens a lesson for the student. Raises ProgressError."""
        from kit.school.lessons.lesson_session import LessonSession

        return LessonSession(lesson, self.progress(), self.workspace)

    def close(self) -> None:
        with self._opening:
            if self._progress is not None:
                self._progress.close()
                self._progress = None

    def _game(
        self, events: list[ProgressEvent]
    ) -> tuple[str, GameLevel | None, tuple[tuple[str, int, int], ...]]:
        """The medal in reach, the next level, and what was won of each world; nothing where the game's files cannot be
        read."""
        from kit.school.game.challenges import game_summary
        from kit.school.game.levels import all_levels
        from kit.school.game.medal import Medal
        from kit.school.game.medal_in_reach import medals_in_reach
        from kit.school.game.player_progress import completed_lessons
        from kit.world.problems import WorldError

        try:
            summary = game_summary(events, completed_lessons(all_levels(), events))
        except (WorldError, FileNotFoundError):
            return "", None, ()
        won = tuple(
            (title, sum(medal is not Medal.NONE for medal in best), len(best))
            for title, best in summary.best_by_world.items()
        )
        is_next = (each.level for each in summary.levels if each.is_open and each.best_medal is Medal.NONE)
        medals = [each.describe() for each in medals_in_reach(summary.levels)]
        return next(iter(medals), ""), next(is_next, None), won

    def _running(self) -> tuple[str, ...]:
        from kit.learning.training.run_folders import list_runs

        return tuple(each.name for each in list_runs(self.workspace.runs) if each.is_active)

    def _count_due(self) -> int | None:
        from kit.school.quiz.items import read_bank
        from kit.school.quiz.quiz_session import local_now
        from kit.school.quiz.schedule import build_schedule
        from kit.world.problems import WorldError

        try:
            return len(build_schedule(read_bank(), self.progress().events(), local_now()).queue)
        except (WorldError, FileNotFoundError):
            return None
