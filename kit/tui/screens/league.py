"""The league: its standings, the matches of each entrant, and each match as a replay with both."""

from __future__ import annotations

import os
import time
from asyncio import Lock, to_thread
from collections.abc import Collection, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import ClassVar, Final

from textual import events, work
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.worker import Worker, get_current_worker

from kit.controllers import user_controllers
from kit.dialogue.actions import ScreenActions
from kit.dialogue.screen_action import letter
from kit.document.blocks import Text, Tone
from kit.document.layout import Page, rows_of
from kit.document.rows import Row, at_both_edges, broken, row, side_by_side
from kit.document.tables import list_rows
from kit.host.job_folder import JobExecutor
from kit.school.game.league.entries import LeagueError, program_of_agent, renew_beside_former, submit
from kit.school.game.league.league import RACE_LIMIT, League, LeagueJob, seconds_left
from kit.school.game.league.league_blocks import (
    KEYS,
    job_title,
    level_grid,
    matches_table,
    result_sentence,
    standings_table,
    summary_blocks,
)
from kit.school.game.league.standings import Match, Standings, match_film, read_standings
from kit.school.game.two_players import TAG_RULE
from kit.tui.rows.key_rows import bindings, footer
from kit.tui.rows.progress_marks import share_bar
from kit.tui.rows.training_rows import clock
from kit.tui.screens.agents import agent_items
from kit.tui.screens.dialogs import HelpDialog, MessageDialog
from kit.tui.screens.level_drive import LeftError
from kit.tui.screens.level_pictures import pictures_of
from kit.tui.screens.match_replay import MatchReplayScreen
from kit.tui.screens.picker import Picker, PickerItem
from kit.tui.theme import Theme
from kit.tui.widgets.text_rows import RowsScreen, TextRows
from kit.workspace import Workspace

WIDE: Final = 110
"""Columns from which the matches stand beside the standings."""
STANDINGS_WIDTH: Final = 68
GRID_SIGNS: Final = "+ won, - lost, = drawn"
STOPS: Final = "Esc stops it, and t goes on."
LEAST_MAP_ROWS: Final = 12
"""Rows without which the levels' maps are not shown."""


class LeagueScreen(RowsScreen[None]):
    """Enter goes from an entrant to its matches, and from a match to its replay."""

    AUTO_FOCUS = ""
    screen_actions = ScreenActions(
        "league",
        ("choose", "open", "enter_program", "run_matches", "help", "back"),
        own=(
            letter("enter_program", "e", "enter", "enter one of your programs or agents"),
            letter("run_matches", "t", "run", "run the matches that have not been driven"),
        ),
    )  # fmt: skip
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)
    DEFAULT_CSS = """
    LeagueScreen { layout: vertical; }
    LeagueScreen #heading, LeagueScreen #keys { height: 1; }
    LeagueScreen #note { height: auto; min-height: 1; }
    LeagueScreen #body { height: 1fr; }
    """

    def __init__(self, theme: Theme, league: League, workspace: Workspace) -> None:
        super().__init__()
        self._theme = theme
        self._league = league
        self._workspace = workspace
        self._standings: Standings | None = None
        self._chosen: int | None = None
        """The number of the chosen entrant, one's own at first; None before one is known."""
        self._match: int | None = None
        """The number of the chosen one among the entrant's matches; None while an entrant is chosen."""
        self._note = ""
        self._reading = Lock()
        self._asked = self._read_for = 0
        """How often the standings were asked for, and how many of these they answer."""
        self._is_running = False
        self._driving: Row = ()
        """How far a run is and what is driven now; empty where nothing is."""
        self._maps: list[Row] = []
        """Pictures of what is driven, beside the rules of a league that nobody has entered yet."""

    def compose(self) -> ComposeResult:
        for name in ("heading", "body", "note", "keys"):
            yield TextRows(id=name)

    def on_mount(self) -> None:
        self._note = "Opening the league ..."
        self._read()

    def on_resize(self, event: events.Resize) -> None:
        self.call_after_refresh(self._show)
        self._draw_maps()

    @work(group="read")
    async def _read(self, note: str | None = "") -> None:
        await self._read_now(note)

    async def _read_now(self, note: str | None = "") -> None:
        """Reads the standings, once at a time: all that ask while that goes on share one more reading after it. ``note``: is told
        then; None: what is told stays."""
        self._asked += 1
        asked, worker = self._asked, get_current_worker()

        begun_s, first_unread = time.monotonic(), 0

        def show_so_far(standings: Standings) -> None:
            nonlocal begun_s, first_unread
            self._end_if_left(worker)
            if standings.unread > first_unread:  # what was judged before needs no time
                begun_s, first_unread = time.monotonic(), standings.unread
            read = first_unread - standings.unread
            left_s = (time.monotonic() - begun_s) * standings.unread / read if read else None
            self._show_so_far(standings, left_s)

        try:
            async with self._reading:
                if self._read_for < asked:
                    newest = self._asked
                    self._take(await to_thread(read_standings, self._league, show_so_far))
                    self._read_for = newest
        except LeftError:
            return
        except (LeagueError, OSError) as error:
            note = str(error)
        if note is not None:
            self._note = note
        if self.is_attached:
            self._show()
            if note is not None:
                self._draw_maps()

    def _take(self, standings: Standings) -> None:
        """Who is chosen stays chosen, and so does the match."""
        is_chosen = bool(self._entrants) and (self._chosen is not None or self._match is not None)
        name = self._entrants[self._at] if is_chosen else ""
        jobs = None if self._match is None else self._matches[self._match].jobs
        self._standings = standings
        self._chosen = self._entrants.index(name) if name in self._entrants else None
        if jobs is not None:
            found = (number for number, each in enumerate(self._matches) if each.jobs == jobs)
            self._match = next(found, None)

    def _show_so_far(self, standings: Standings, left_s: float | None) -> None:
        """Shows what has been read at first, from the thread that reads; later what is whole stays until it has been read anew.
        ``left_s``: how long the rest takes [s], once that is known."""
        if self._standings is not None and not self._standings.unread:
            return

        def show() -> None:
            self._take(standings)
            self._note = (
                ""
                if left_s is None or not standings.unread
                else f"Running the drives again: about {clock(left_s)} left."
            )
            self._show()

        self.app.call_from_thread(show)

    def _end_if_left(self, worker: Worker[object]) -> None:
        """Ends what a thread computes for a worker that nobody waits for any more: only the worker itself ends by being
        cancelled. Raises LeftError."""
        if not self.is_attached or worker.is_cancelled:
            raise LeftError("The league was left.")

    @work(exclusive=True, group="maps")
    async def _draw_maps(self) -> None:
        if self._standings is None or self.size.width < WIDE:
            return
        levels = (*self._standings.programme.races, *self._standings.programme.tag)
        width, height = self.size.width - STANDINGS_WIDTH, self.size.height - 5
        if self._standings.own_places:
            width, height = self.size.width - 3, height - len(self._tables(self._standings, *self._room))
        glyphs = self._theme.terminal.glyphs.value
        is_there = height >= LEAST_MAP_ROWS
        self._maps = await to_thread(pictures_of, levels, width, height, glyphs) if is_there else []
        self._show()

    # What is shown

    @property
    def _entrants(self) -> list[str]:
        return [] if self._standings is None else [each.entry.name for each in self._standings.places]

    @property
    def _has_own(self) -> bool:
        """Whether anybody but the house is entered: else what is driven is shown in place of matches."""
        return self._standings is not None and bool(self._standings.own_places)

    @property
    def _at(self) -> int:
        """The number of the chosen entrant: one's own where none has been chosen."""
        places = () if self._standings is None else self._standings.places
        if self._chosen is not None:
            return max(0, min(self._chosen, len(places) - 1))
        return next((number for number, each in enumerate(places) if each.entry.is_mine), 0)

    @property
    def _matches(self) -> Sequence[Match]:
        """Those of the chosen entrant."""
        if self._standings is None or not self._entrants:
            return ()
        return self._standings.matches_of(self._entrants[self._at])

    def _show(self) -> None:
        if not self.is_attached:
            return
        width, standings = self.size.width, self._standings
        title = "League" if standings is None else standings.title
        place = f"{self._league.folder}".replace(str(Path.home()), "~", 1)
        has_room = len(title) + len(place) + 2 <= width
        self._rows("heading").show(
            [at_both_edges(row((title, "title")), row((place if has_room else "", "dim")), width)]
        )
        tables = [] if standings is None else self._tables(standings, *self._room)
        below = [row(), *(row("   ", *each) for each in self._maps)] if self._has_own and self._maps else []
        has_room = width >= WIDE and len(tables) + len(below) <= self._room[1]
        self._rows("body").show([*tables, *below] if has_room else tables)
        told = self._note or (
            STOPS if self._is_running and width >= WIDE else "" if self._driving else self._told_of_match
        )
        beside = (" " if told and self._driving else "", "dim")
        note = broken(row("  ", (told, "dim"), beside, *self._driving), width)
        if self._driving and len(note) > self._note_rows:  # how far it is goes before what else is told
            note = broken(row("  ", *self._driving), width)
        self._rows("note").show(note[: self._note_rows])
        labels = {"open": "matches" if self._match is None else "replay"}
        keys = footer(self.screen_actions, width, labels=labels, without=self.unavailable_actions)
        self._rows("keys").show([keys])

    @property
    def unavailable_actions(self) -> tuple[str, ...]:
        """What needs an entrant, and what needs a match of the chosen one: the first may be there before it has been read."""
        if not self._entrants:
            return "choose", "open", "run_matches"
        return () if self._matches else ("open",)

    @property
    def _told_of_match(self) -> str:
        """What both did in the chosen match: the table has no room for it on most screens."""
        if self._match is None:
            return ""
        return result_sentence(self._matches[self._match])

    @property
    def _room(self) -> tuple[int, int]:
        """Columns and rows between the heading and the note."""
        return self.size.width, self.size.height - 2 - self._note_rows

    @property
    def _note_rows(self) -> int:
        """Rows for what is told below: of a match and of a run in two, so that nothing moves from one to the next."""
        return 1 if self._match is None and not self._driving else 2

    def _tables(self, standings: Standings, width: int, height: int) -> list[Row]:
        """Standings and matches, beside each other where there is room, or what a league is where nobody is entered."""
        is_wide = width >= WIDE
        left_width = STANDINGS_WIDTH if is_wide else width
        head = [row(), *rows_of(summary_blocks(standings, KEYS), Page(left_width - 4, margin=2)), row()]
        room = height - len(head)
        left: list[Row] = list(head)
        name = self._entrants[self._at] if self._entrants else ""
        if standings.places:
            left += list_rows(standings_table(standings), left_width, room, self._at)
            grid = level_grid(standings, name)
            below = rows_of([grid, Text(GRID_SIGNS, Tone.DIM)], Page(left_width - 4, margin=2))
            if is_wide and grid.rows and len(left) + len(below) + 1 <= height:
                left += [row(), *below]
        table = matches_table(self._matches, name)
        has_maps = not self._has_own and self._match is None and is_wide
        right: list[Row] = [row(), row((f"   Matches of {name}" if name else "", "title")), row()]
        if table.rows:
            right_width = width - left_width if is_wide else width
            if self._match is None:
                right += rows_of([replace(table, is_ruled=False)], Page(right_width - 3, margin=3))
            else:
                right += list_rows(table, right_width, height - len(right), self._match)
        elif name:
            right.append(row(("   None has been driven yet.", "dim")))
        if has_maps:
            right = [row(), *self._maps]
        if is_wide:
            return side_by_side(left, right, left_width)
        return right if self._match is not None else [*left, *(right if self._entrants else ())][:height]

    # Keys

    def action_choose(self, columns: int, rows: int) -> None:
        if self._match is not None and columns >= 0:
            self._match = max(0, min(self._match + rows, len(self._matches) - 1))
        elif columns < 0:
            self._match = None
        elif columns > 0:
            self._match = 0 if self._matches else None
        else:
            self._chosen = max(0, min(self._at + rows, len(self._entrants) - 1))
        self._show()

    @work(exclusive=True, group="open")
    async def action_open(self) -> None:
        if self._match is None:
            self._match = 0 if self._matches else None
            self._show()
            return
        self._show_note("Running the drives again ...")
        try:
            match = self._matches[self._match]
            end_if_left = partial(self._end_if_left, get_current_worker())
            film = await to_thread(match_film, self._league, match, end_if_left)
        except LeftError:
            return
        except LeagueError as error:
            self._show_note(str(error))
            return
        self._show_note("")
        self.app.push_screen(MatchReplayScreen(self._theme, match, film))

    def action_back(self) -> None:
        if self._match is not None:
            if self.workers.cancel_group(self, "open"):
                self._note = ""
            self._match = None
            self._show()
            return
        super().action_back()

    def action_help(self) -> None:
        self.app.push_screen(HelpDialog("The league", self.screen_actions, NOTES))

    @work(exclusive=True, group="enter")
    async def action_enter_program(self) -> None:
        """Has the user choose a program or an agent, and enters it."""
        programs = {each.name: each for each in user_controllers(self._workspace.controllers)}
        agents = await to_thread(agent_items, self._workspace.runs, "agent ")
        choices = [PickerItem(f"program {name}", name, each.title) for name, each in programs.items()]
        picked = await self.app.push_screen_wait(
            Picker("Which of yours enters the league?", [*choices, *agents])
        )
        if picked is None:
            return
        kind, _, name = picked.partition(" ")
        try:
            if kind == "program":
                program = programs[name].file.read_bytes()
            else:
                program = await to_thread(program_of_agent, name, self._workspace.runs)
            enter = submit if await self._replaces(name, program) else renew_beside_former
            await to_thread(enter, self._league.folder, name, program)
        except (LeagueError, OSError) as error:
            self.app.push_screen(MessageDialog("Not entered", str(error)))
            return
        entered = f"{name} is entered."
        await self._read_now(entered)
        if self._league.is_mine:
            self._run_matches(entered)

    async def _replaces(self, name: str, program: bytes) -> bool:
        """Whether a program takes the place of the one that is entered under its name; asks where that is another one."""
        entries = await to_thread(self._league.entries)
        if not any(each.name == name and each.is_mine and each.differs_from(program) for each in entries):
            return True
        choices = [
            PickerItem("replace", "replace it"),
            PickerItem("keep", "keep it", "it stays as an entry of its own, a rival to beat"),
        ]
        picked = await self.app.push_screen_wait(Picker(f"Another {name} is entered. What of that?", choices))
        return picked != "keep"

    def action_run_matches(self) -> None:
        self._run_matches()

    @work(group="run")
    async def _run_matches(self, note: str = "") -> None:
        """Runs what is missing, in processes of their own; what is done stays where the screen is left. ``note``: is told
        meanwhile."""
        if self._is_running or self._standings is None or self._standings.unread:
            return
        self._is_running = True
        keys: tuple[str, ...] = ()
        try:
            keys = await to_thread(self._league.prepare_run)
            jobs = await to_thread(self._league.jobs)
            waiting = [each for each in jobs if each.key in keys]
            done = {each.key for each in jobs if each.key not in keys}
            begun_s = time.monotonic()

            def count(key: str) -> None:
                if not self.is_attached:
                    raise LeftError("The league was left.")
                done.add(key)
                left_s = seconds_left(waiting, done, time.monotonic() - begun_s)
                self.app.call_from_thread(self._show_count, jobs, done, left_s)
                self.app.call_from_thread(self._read, None)

            if keys:
                self._note = note
                self._show_count(jobs, done)
                executor = JobExecutor(jobs=os.cpu_count() or 1)
                await to_thread(executor.run, self._league, keys, count)
        except LeftError:
            return
        except (LeagueError, OSError) as error:
            self.app.push_screen(MessageDialog("The league cannot be run", str(error)))
            return
        finally:
            self._is_running = False
        self._driving = row(("Running the drives again ...", "dim")) if keys else ()
        self._show()
        idle = "All matches are driven." if len(self._entrants) > 1 else "A match needs two entrants."
        await self._read_now(f"{len(keys)} were driven." if keys else idle)
        self._driving = ()
        self._show()

    def _show_count(
        self, jobs: Sequence[LeagueJob], done: Collection[str], left_s: float | None = None
    ) -> None:
        self._driving = driving_row(jobs, done, left_s)
        self._show()

    def _show_note(self, note: str) -> None:
        self._note = note
        self._show()


def driving_row(jobs: Sequence[LeagueJob], done: Collection[str], left_s: float | None) -> Row:
    """How far a run is, and what is driven now; empty at its end. ``jobs``: all of it, in the order in which they are begun.
    ``done``: keys. ``left_s``: what the rest takes [s], once that is known."""
    rest = [each for each in jobs if each.key not in done]
    if not rest:
        return ()
    left = "" if left_s is None else f", {clock(left_s)} left"
    count = f" {len(jobs) - len(rest)} of {len(jobs)}{left}  "
    return row((share_bar(1.0 - len(rest) / len(jobs)), "good"), count, (job_title(rest[0]), "bold"))


NOTES: Final = (
    ("rating", "400 points more: wins ten times as often (Bradley-Terry)"),
    ("95 %", "where the rating lies, as far as these matches tell"),
    (
        "race",
        (
            f"each drives alone from five starts; the middle drives are compared. A drive ends after {RACE_LIMIT:.0f} times the "
            "reference's time"
        ),
    ),
    ("tag", f"two robots in one world. {TAG_RULE}"),
)
