"""The leaderboard of this machine: who has how many medals, who was quickest on each level; one key joins and leaves it."""

from __future__ import annotations

import getpass
from asyncio import to_thread
from collections.abc import Sequence
from typing import ClassVar, Final

from textual import events, work
from textual.binding import BindingType

from kit.dialogue.actions import ScreenActions
from kit.dialogue.screen_action import letter
from kit.document.blocks import Block, Table, Text, Tone
from kit.document.layout import Page, rows_of
from kit.document.rows import MARGIN, Row, row, row_width, side_by_side
from kit.document.tables import table_columns, table_rows
from kit.school.game import leaderboard
from kit.school.game.daily import daily_level, today
from kit.school.game.drive_records import join_leaderboard
from kit.school.game.levels import all_levels
from kit.school.game.medal import RUNGS
from kit.school.game.medal_in_reach import medals_in_reach
from kit.school.game.player_progress import LevelProgress, level_progress
from kit.school.game.race import DriverKind
from kit.school.game.references import reference_seconds
from kit.school.progress import EventKind, ProgressError, ProgressJournal
from kit.tui.rows.key_rows import bindings, footer
from kit.tui.rows.leaderboard_rows import (
    leaderboard_standings,
    leaderboard_times,
    times_to_beat,
    todays_times,
)
from kit.tui.rows.level_card_rows import Company, level_card
from kit.tui.rows.progress_rows import reach_table
from kit.tui.rows.ruled_title import ruled_title
from kit.tui.screens.dialogs import HelpDialog, MessageDialog
from kit.tui.screens.level_pictures import picture_of, picture_rows
from kit.tui.screens.text_screen import TextScreen
from kit.tui.theme import Theme
from kit.tui.widgets.text_rows import TextRows
from kit.workspace import Workspace
from kit.world.problems import WorldError

WIDE: Final = 118
"""Columns from which today's level stands beside the times."""
BOARD: Final = 88
"""Columns of standings and times at most, where it does."""
NOTES: Final = (
    ("a time", "the best drive of one player, run again before it is shown"),
    ("another machine", "driven on another kind of machine, where it is the same but not to the bit"),
    ("as ... before", "the same drive, which somebody else had first"),
)
"""What the board shows."""
MAP_ROWS: Final = 24
ROWS_AROUND: Final = 4
"""Of the screen: the heading, an empty row below it and one above the keys, and these."""
MOST_IN_REACH: Final = 8
"""Medals that are named."""


class LeaderboardScreen(TextScreen, inherit_bindings=False):
    """Shows all who have joined."""

    screen_actions = ScreenActions(
        "leaderboard",
        ("scroll", "join", "help", "back"),
        ("close",),
        own=(
            letter("join", "j", "join", "add or remove your name and drives"),
        ),
    )  # fmt: skip
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)

    def __init__(self, theme: Theme, journal: ProgressJournal, workspace: Workspace) -> None:
        super().__init__("Leaderboard", ())
        self._theme = theme
        self._progress = journal
        self._workspace = workspace
        self._folder = leaderboard.leaderboard_folder()
        self._player_name = journal.student_name or getpass.getuser()
        self._has_joined = False
        self._standings: list[Block] = [Text("Running the drives again ...", Tone.DIM)]
        self._times: tuple[Table, ...] = ()
        """The same times, the table that tells most first."""
        self._today: list[Row] = []
        """What stands beside them on a wide screen."""

    def on_mount(self) -> None:
        self._read()

    def on_resize(self, event: events.Resize) -> None:
        self._width = 0  # Textual calls the inherited handler after this one, which then wraps the rows again

    def _arranged(self, width: int, height: int) -> list[Row]:
        """The standings and times, and beside them today's level and the player's next medals where there is room."""
        if width < WIDE:
            return self._board(width, height)
        column = width - self._today_columns
        return side_by_side(self._board(column, height), [row(), *self._today], column)

    @property
    def _today_columns(self) -> int:
        return max(self.size.width * 2 // 5, self.size.width - BOARD)

    def _board(self, width: int, height: int) -> list[Row]:
        """The standings, and below them the times, in as many columns as there is room for."""
        page = Page(width=width - 2 * MARGIN, margin=MARGIN)
        rows = [row(), *rows_of(self._standings, page)]
        room = max(1, height - len(rows) - 1)
        placed = [table_columns(table, page.width, room) for table in self._times]
        fitting = [each for each in placed if max(map(row_width, each), default=0) <= page.width]
        times = min(fitting or placed[-1:], key=lambda each: max(len(each), room), default=[])
        return [*rows, row(), *(row(" " * MARGIN) + each for each in times)]

    @work(exclusive=True, group="read")
    async def _read(self) -> None:
        """Judges the drives, which takes a moment where they were not judged before."""
        self._has_joined = leaderboard.has_joined(self._folder)
        entries = await to_thread(leaderboard.read_entries, self._folder)
        own = await to_thread(self._own_progress)
        self._today = await to_thread(self._beside, entries, own) if self.size.width >= WIDE else []
        self._standings = leaderboard_standings(leaderboard.standings(entries), self._offer)
        to_beat = (times_to_beat(own, medals) for medals in (RUNGS[:-1], RUNGS[1:3], RUNGS[2:3], ()))
        self._times = (leaderboard_times(entries),) if entries else tuple(to_beat)
        self._width = 0
        if self.query(TextRows):  # not where the screen was left meanwhile
            self._show()

    def _beside(
        self, entries: Sequence[leaderboard.LeaderboardEntry], own: Sequence[LevelProgress]
    ) -> list[Row]:
        """Today's level with its board and what it asks for, and the player's next medals."""
        level = daily_level(today())
        columns, glyphs = self._today_columns - MARGIN, self._theme.terminal.glyphs.value
        times = _rows_of(todays_times(entries), columns)
        nearest = _rows_of(reach_table(medals_in_reach(own)[:MOST_IN_REACH]), columns)
        rows = [
            ruled_title("today's maze", columns, level.title),
            *picture_rows(picture_of(level, columns, min(MAP_ROWS, columns // 3), glyphs)),
            row(),
            *(times or [row(("Nobody on the board has driven it yet.", "dim"))]),
            row(),
        ]
        reach = [ruled_title("your nearest medals", columns), *nearest] if nearest else []
        room = self.size.height - ROWS_AROUND - len(rows) - len(reach) - 1
        card = level_card(level, DriverKind.HAND, reference_seconds(level), (), columns, room, Company())
        asked = [each for part in card.values() for each in part]
        return [*rows, *asked, *([row()] if asked and reach else []), *reach]

    def _own_progress(self) -> tuple[LevelProgress, ...]:
        try:
            return level_progress(all_levels(), self._progress.events(EventKind.FINISH))
        except (ProgressError, WorldError):  # both are told where one comes from
            return ()

    @property
    def _offer(self) -> str:
        """What the key for it does."""
        if self._has_joined:
            return (
                "You are on it. j takes your name and drives off; a drive that was yours first stays yours."
            )
        return f"j adds you as {self._player_name}: everyone on this machine sees your name and drives."

    def _keys(self) -> Row:
        labels = {"join": "leave" if self._has_joined else "join"}
        return footer(self.screen_actions, self.size.width, labels=labels, without=self.unavailable_actions)

    def action_help(self) -> None:
        self.app.push_screen(HelpDialog("Leaderboard", self.screen_actions, NOTES))

    @work(exclusive=True, group="join")
    async def action_join(self) -> None:
        """Joins, or leaves."""
        try:
            if self._has_joined:
                leaderboard.remove_own_entry(self._folder)
            else:
                await to_thread(join_leaderboard, self._progress, self._workspace, self._player_name)
        except (leaderboard.LeaderboardError, ProgressError) as error:
            self.app.push_screen(MessageDialog("Leaderboard", str(error)))
        self._read()


def _rows_of(table: Table, columns: int) -> list[Row]:
    return [each for rows in table_rows(table, columns).entries for each in rows]
