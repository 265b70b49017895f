"""What a student has done so far: the game, the quiz by topic, lessons and exercises, and how to take it along."""

from __future__ import annotations

from asyncio import to_thread
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import date, datetime
from typing import Any, ClassVar, Final

from textual.binding import BindingType
from textual.screen import Screen

from kit.dialogue.actions import ScreenActions
from kit.document.blocks import Block, Text
from kit.document.rows import Row, row
from kit.school.badges import Badge, Streak, badge_table, badges, learning_days, streak
from kit.school.game.medal_in_reach import MedalInReach, medals_in_reach
from kit.school.lessons.catalogue import LessonEntry
from kit.school.lessons.reading import read_units
from kit.school.progress import EventKind, ProgressEvent
from kit.school.quiz.items import read_bank
from kit.tui.rows.key_rows import bindings
from kit.tui.rows.progress_rows import (
    calendar_rows,
    export_blocks,
    lesson_counts,
    lesson_rows,
    reach_table,
    section,
    section_of,
    short_lesson_rows,
)
from kit.tui.screens.dialogs import HelpDialog, MessageDialog
from kit.tui.screens.lessons import MARKS
from kit.tui.screens.text_screen import LEAST_COLUMN, SectionsScreen
from kit.tui.student_store import StudentStore
from kit.world.problems import WorldError

MOST_IN_REACH: Final = 5
"""Medals that are named."""
HIGH: Final = 45
"""Rows of a screen from which on badges are listed that are not yet begun."""


NO_STREAK: Final = Streak(0, 0)


@dataclass(frozen=True, slots=True)
class ProgressSummary:
    """All that is shown of one student."""

    shelf: Sequence[LessonEntry]
    workspace: str
    today: date
    game: Sequence[Row] = ()
    in_reach: Sequence[MedalInReach] = ()
    """The next medals, the nearest first."""
    days: Mapping[date, int] = field(default_factory=dict)
    """How much was learned on each day on which anything was."""
    streak: Streak = NO_STREAK
    badges: Sequence[Badge] = ()
    quiz: Sequence[Block] = (Text("Nothing answered yet."),)


class ProgressScreen(SectionsScreen):
    """Shows all that was done; the lessons beside the rest where there is room, each in one row."""

    screen_actions = ScreenActions("progress", ("scroll", "help", "back"), ("close",))
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)

    def __init__(self, summary: ProgressSummary) -> None:
        super().__init__("Progress", self._told, fewest=2)
        self._summary = summary

    def _told(self, columns: int) -> list[Sequence[Row]]:
        """The sections for a column of this width."""
        told = self._summary
        is_alone = columns > self._width - LEAST_COLUMN
        parts = [section("the game", told.game, columns)]
        if told.in_reach:
            parts.append(section_of("nearest medals", [reach_table(told.in_reach)], columns))
        if told.days:
            days = [row(f"  {told.streak.describe()}"), row(), *calendar_rows(told.days, told.today, columns)]
            parts.append(section("days", days, columns))
        parts.append(section_of("quiz", told.quiz, columns))
        is_high = self.size.height >= HIGH
        if shown := [each for each in told.badges if each.done or is_high]:
            parts.append(section_of("badges", [badge_table(shown)], columns))
        parts.append(section_of("export your progress", export_blocks(told.workspace), columns))
        counts = section("done so far", lesson_counts(told.shelf), columns)
        return [
            *parts,
            counts,
            lesson_rows(told.shelf) if is_alone else short_lesson_rows(told.shelf, columns),
        ]

    def action_help(self) -> None:
        self.app.push_screen(HelpDialog("Progress", self.screen_actions, MARKS))


async def show_progress(screen: Screen[Any], store: StudentStore) -> None:
    """Opens the page, and comes back when it is left. To be called in a worker."""
    found = await to_thread(_read, store)
    if isinstance(found, str):
        screen.app.push_screen(MessageDialog("Progress cannot be read", found))
    else:
        await screen.app.push_screen_wait(ProgressScreen(found))


def _read(store: StudentStore) -> ProgressSummary | str:
    """Reads the lessons and all else, or the problem; runs in another thread, since there are many files."""
    overview = store.read_overview()
    if overview.problem:
        return overview.problem
    events = store.progress().events()
    today = datetime.now().astimezone().date()
    game, in_reach = _game(store)
    in_a_row, days = streak(events, today), learning_days(events)
    won = badges(overview.shelf, read_units(), in_a_row, events)
    return ProgressSummary(
        overview.shelf,
        str(store.workspace.folder),
        today,
        game,
        in_reach,
        days,
        in_a_row,
        won,
        _quiz(events),
    )


def _game(store: StudentStore) -> tuple[list[Row], list[MedalInReach]]:
    from kit.school.game.challenges import game_summary
    from kit.tui.rows.level_rows import game_progress

    try:
        summary = game_summary(store.progress().events(EventKind.FINISH))
    except (WorldError, FileNotFoundError) as error:
        return [row(f"  {line}") for line in str(error).splitlines()], []
    return game_progress(summary), medals_in_reach(summary.levels)[:MOST_IN_REACH]


def _quiz(events: list[ProgressEvent]) -> list[Block]:
    from kit.school.quiz.answers import answers_from_events
    from kit.school.quiz.quiz_session import local_now
    from kit.school.quiz.quiz_text import scores_blocks
    from kit.school.quiz.schedule import build_schedule

    try:
        bank = read_bank()
    except (WorldError, FileNotFoundError) as error:
        return [Text(line, is_tight=True) for line in str(error).splitlines()]
    answers = answers_from_events(events)
    if not answers:
        return [Text("Nothing answered yet.")]
    return scores_blocks(bank, answers, build_schedule(bank, events, local_now()))
