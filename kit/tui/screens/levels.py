"""The levels, world by world: medals, stars, what is open, who was quickest; Enter drives one."""

from __future__ import annotations

from asyncio import Future, ensure_future, shield, to_thread
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Final

from textual import events, work
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal

from kit.controllers import ControllerFile, kit_controllers, user_controllers
from kit.dialogue.actions import ScreenActions
from kit.dialogue.screen_action import letter
from kit.document.rows import MARGIN, Row, at_both_edges, fitted, row, row_width, side_by_side
from kit.plain_text import counted
from kit.render.scene import Scene
from kit.run.recording import Recording, RecordingError, load_recording
from kit.school.game.challenge import Challenge
from kit.school.game.challenges import all_challenges, challenge_events, challenge_medals, starts_clock
from kit.school.game.daily import DAILY_PREFIX, daily_level, streak, today
from kit.school.game.ghosts import Ghost, ghost_file, level_ghosts, load_unfinished
from kit.school.game.levels import CHALLENGES_WORLD, GameLevel, GameWorld, all_levels, all_worlds
from kit.school.game.medal import Medal
from kit.school.game.ordinary_drives import ordinary_drives
from kit.school.game.player_progress import (
    BELTS,
    BY_HAND,
    DriverFacts,
    ExtraRule,
    GameSummary,
    LevelProgress,
    completed_lessons,
    level_progress,
    open_level_after,
)
from kit.school.game.race import DriverKind, agent_controller
from kit.school.game.references import reference_recording, reference_seconds
from kit.school.game.starts import film_scenario
from kit.school.lessons.shell_lines import shell_path
from kit.school.news import take_news
from kit.school.progress import EventKind, ProgressError, ProgressJournal
from kit.tui.rows import challenge_rows, level_rows
from kit.tui.rows.key_rows import bindings, footer
from kit.tui.rows.ladder_rows import ORDINARY, drivers_by_ladder, ladder_letters, rung_rows
from kit.tui.rows.level_card_rows import COLUMN, best_splits, level_card, star_line, stars_and_sectors
from kit.tui.rows.level_map_rows import LevelPlace, level_at, map_places, map_rows
from kit.tui.rows.progress_marks import share_bar
from kit.tui.rows.ruled_title import ruled_title
from kit.tui.screens.agents import agent_items
from kit.tui.screens.dialogs import HelpDialog, MessageDialog
from kit.tui.screens.dialogue import WIDEST_BESIDE
from kit.tui.screens.leaderboard import LeaderboardScreen
from kit.tui.screens.level_pictures import company_of, ghost_paths, picture_of, picture_rows, scene_of
from kit.tui.screens.picker import Picker, PickerItem
from kit.tui.theme import Theme
from kit.tui.widgets.text_rows import RowClicked, RowsScreen, TextRows
from kit.tui.widgets.world_view import WorldView
from kit.workspace import Workspace

if TYPE_CHECKING:
    from kit.learning.policies.policy import Policy

ABOUT_ROWS: Final = 8
"""What is said of a level, and an empty row above the keys."""
MAP_WIDTH: Final = 84
"""Columns of the list where the chosen level is shown beside it."""
CARD_WIDTH: Final = 50
"""Columns of the chosen level's card, which on a wide screen stands at the right of its map."""
ROOM_FOR_CARD: Final = MAP_WIDTH + 36 + CARD_WIDTH
"""Columns of the screen from which on it does."""
CARD_PARTS: Final = ("stars", "rivals", "sectors")
"""Of the card, below the rungs of each driver: the rest is said below the list."""
NOTES: Final = (
    ("B S G M R", "bronze, silver, gold, master, record: each driver has a ladder"),
    (ORDINARY, "where an ordinary hand, a tidy program, an agent of the kit's preset stands on it"),
    (
        "*",
        "a star for an extra rule that a drive has kept: no bump, no stop, one sensor, few lines, few training steps",
    ),
    (
        "belt",
        (f"of a world: {', '.join(f'{each.name} for {each.task}' for each in BELTS)}"),
    ),
    ("bump", "by hand back to the start, with all targets to be reached again"),
    *level_rows.PROGRAM_NOTES,
    ("side by side", "a pair that is apart for longer gets bronze at best"),
    ("locked", "opens after any one of the levels before it, or its lesson; on the map ( )"),
)


DRIVE_ACTIONS: Final = ("hand_over", "agent", "replay", "two_players")
"""Actions that a challenge does not have."""
NEW_AGENT: Final = " "
"""Instead of the name of a run, of which none is blank."""
STARTS: Final = (*DRIVE_ACTIONS, "open", "daily")
"""Actions that begin a drive or a replay."""
GIVEN_UP: Final = (
    "Today's run has counted, without a finish. d drives the maze again as practice, f shows its board; "
    "tomorrow there is another one."
)
"""What is said of a run of the day that was left."""
ROOM_FOR_WORDS: Final = 100
"""Columns from which on the line of keys has its usual words."""
SHORT_WORDS: Final = {"leaderboard": "board", "two_players": "players"}
"""Words of keys where there are fewer, by action."""
ROWS_ABOVE_LEVELS: Final = 4
"""Of the list: the world's two, one of news or an empty one, the columns' names."""
ROWS_AROUND: Final = 2
"""Of the screen: the heading and the line of keys."""


class LevelsScreen(RowsScreen[None]):
    """Draws nothing but what a key has changed."""

    AUTO_FOCUS = ""
    screen_actions = ScreenActions(
        "levels",
        ("open", "hand_over", "agent", "leaderboard", "two_players", "replay", "daily", "choose", "help", "back"),
        own=(
            letter("agent", "a", "agent", "let an agent that you trained drive the level"),
            letter("leaderboard", "f", "leaderboard", "show this machine's leaderboard"),
            letter("daily", "d", "today's maze", "drive today's maze, the same for everyone"),
            letter("two_players", "2", "two players", "tag or a race: with a program, or another player"),
        ),
    )  # fmt: skip
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)
    HORIZONTAL_BREAKPOINTS = [(0, "-narrow"), (MAP_WIDTH + 36, "-wide")]  # noqa: RUF012 - Textual's own attribute
    DEFAULT_CSS = f"""
    LevelsScreen {{ layout: vertical; }}
    LevelsScreen #heading {{ height: 1; }}
    LevelsScreen #middle {{ height: 1fr; }}
    LevelsScreen #preview, LevelsScreen #card {{ display: none; }}
    LevelsScreen.-wide #map {{ width: {MAP_WIDTH}; }}
    LevelsScreen.-wide #preview {{ display: block; }}
    LevelsScreen.-with-card #card {{ display: block; width: {CARD_WIDTH}; }}
    LevelsScreen.-wide.-challenge #map {{ width: 1fr; }}
    LevelsScreen.-wide.-challenge #preview {{ display: none; }}
    LevelsScreen #about {{ height: {ABOUT_ROWS}; }}
    LevelsScreen.-about-beside #about {{ display: none; }}
    LevelsScreen #keys {{ height: 1; }}
    """

    def __init__(
        self,
        theme: Theme,
        journal: ProgressJournal,
        workspace: Workspace,
        first: GameLevel | Challenge | None = None,
        action: str = "",
    ) -> None:
        """``first``: opened at once, but for a challenge whose clock then begins: that is chosen. ``action``: what is done at
        once."""
        super().__init__()
        self._theme = theme
        self._progress = journal
        self._workspace = workspace
        self._worlds = (*all_worlds(), CHALLENGES_WORLD)
        self._challenges = all_challenges()
        self._challenge_medals: dict[str, Medal] = {}
        self._levels = all_levels()
        self._first, self._action = first, action
        self._found: tuple[LevelProgress, ...] = ()
        self._known: dict[str, tuple[Ghost, ...]] = {}
        self._references = {each.id: reference_seconds(each) for each in self._levels}
        self._completed_lessons: frozenset[str] = frozenset()
        self._preview = WorldView(lambda: theme.encoder, theme.palette, id="preview")
        self._scenes: dict[str, Scene] = {}
        self._pictures: dict[str, list[str]] = {}
        self._preparations: dict[str, Future[tuple[Ghost, ...]]] = {}
        self._prepared: dict[str, float] = {}
        """Share of each level's ghosts that is ready, 0 to 1."""
        self._doing = self._doing_level = ""
        self._news = ""
        """What is new here, at the first visit."""
        shown = (*self._levels, *self._challenges)
        self._at = shown.index(first) if first in shown else 0

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        with Horizontal(id="middle"):
            yield TextRows(id="map")
            yield self._preview
            yield TextRows(id="card")
        yield TextRows(id="about")
        yield TextRows(id="keys")

    def on_mount(self) -> None:
        self._news = take_news(self._progress, self.screen_actions.name)
        self._read()
        if self._first is None:
            self._at = next(
                (number for number, each in enumerate(self._found) if each.is_open and not each.best_times), 0
            )
            self._choose_cut_short()
        self._load_ghosts()
        self._read_lessons()
        if isinstance(self._first, GameLevel):
            self._drive_first(self._first)
        elif self._first is not None and self._first.task.clock is None:
            self.call_after_refresh(self.action_open)
        if self._action:
            self.call_after_refresh(self.run_action, self._action)

    def _choose_cut_short(self) -> None:
        """Names and chooses the level of a drive that a dropped link has ended: it goes on there."""
        drive = load_unfinished(self._workspace)
        number = next((at for at, each in enumerate(self._levels) if drive and drive.level == each.id), None)
        if number is not None:
            self._at = number
            title = self._levels[number].title
            self._news = f"Your drive of {title} was cut short: Enter on {title} goes on with it."
        elif drive is not None and drive.level == daily_level(today()).id:
            self._news = "Your run of today's maze was cut short: d goes on with it."

    def on_resize(self, event: events.Resize) -> None:
        self.call_after_refresh(self._show)
        if self._found:
            self._load_ghosts()

    @property
    def chosen(self) -> LevelProgress:
        """The chosen level. Raises IndexError while a challenge is chosen."""
        return self._found[self._at]

    @property
    def chosen_challenge(self) -> Challenge | None:
        """The chosen challenge; None while a level is chosen. Challenges come after the levels."""
        number = self._at - len(self._found)
        return self._challenges[number] if number >= 0 else None

    @property
    def _world(self) -> GameWorld:
        """The world of what is chosen."""
        name = CHALLENGES_WORLD.id if self.chosen_challenge else self.chosen.level.world
        return next(each for each in self._worlds if each.id == name)

    def _read(self) -> None:
        finishes = self._progress.events(EventKind.FINISH)
        self._found = level_progress(self._levels, finishes, self._completed_lessons)
        self._challenge_medals = challenge_medals(finishes)

    def _daily_text(self, width: int) -> str:
        """What the heading says of the daily challenge, in at most ``width`` columns."""
        days = streak(self._progress.events(EventKind.FINISH), today())
        told = [f", {counted(days, 'day')} in a row", f", {counted(days, 'day')}"] if days else []
        texts = (f"d: today's maze{each}" for each in (*told, ""))
        return next((text for text in texts if len(text) <= width), "")

    @work(exclusive=True, group="lessons")
    async def _read_lessons(self) -> None:
        """Which lessons are completed: reading them all takes a moment."""
        journal = self._progress.events()
        self._completed_lessons = await to_thread(completed_lessons, self._levels, journal)
        if self._completed_lessons:
            self._read()
            self._show()

    def _show(self) -> None:
        # The kit may be left while a ghost is being made: then there are no rows any more.
        if not self.size.width or not self._found or not self.query(TextRows):
            return
        summary = GameSummary(self._found, tuple(self._challenge_medals.values()))
        counts, title = f"{level_rows.medal_counts(summary)} ", " Game   "
        daily = self._daily_text(self.size.width - len(counts) - len(title) - 1)
        self._rows("heading").show(
            [at_both_edges(row((title, "title"), (daily, "dim")), row((counts, "bold")), self.size.width)]
        )
        challenge = self.chosen_challenge
        self.set_class(challenge is not None, "-challenge")
        listed, about = self._level_rows() if challenge is None else self._challenge_rows(challenge)
        if self._doing:
            about = [*about[: ABOUT_ROWS - 1], self._doing_row()]
        self.set_class(self._has_card, "-with-card")
        if challenge is None:
            self.set_class(self._has_card, "-about-beside")
        if self._has_card:
            listed = [*listed, *[row()] * (self._middle_rows - len(listed)), *about]
            self._rows("card").show(self._card_beside())
        self._rows("map").show(listed)
        self._rows("about").styles.height = self._rows_of_about
        self._rows("about").show(about)
        labels = {} if challenge is not None else {"open": "drive"}
        if self.size.width < ROOM_FOR_WORDS:
            labels |= SHORT_WORDS
        keys = footer(self.screen_actions, self.size.width, without=self.unavailable_actions, labels=labels)
        self._rows("keys").show([keys])

    @property
    def unavailable_actions(self) -> tuple[str, ...]:
        """Actions that do nothing for what is chosen."""
        if self.chosen_challenge is not None:
            return DRIVE_ACTIONS
        return () if self.chosen.best_times else ("replay",)

    @property
    def _rows_of_about(self) -> int:
        is_challenge = self.chosen_challenge is not None
        return challenge_rows.most_rows_about(self.size.width - 1) + 1 if is_challenge else ABOUT_ROWS

    @property
    def _middle_rows(self) -> int:
        """Rows between the heading and what is said of what is chosen."""
        return self.size.height - ROWS_AROUND - self._rows_of_about

    def _world_heading(self, best: Sequence[Medal]) -> list[Row]:
        """The rows above a world's list, ROWS_ABOVE_LEVELS with the columns' names. ``best``: the best medal of each entry."""
        number, width = self._worlds.index(self._world) + 1, self._rows("map").size.width
        heading = level_rows.world_heading(self._world, number, len(self._worlds), best, width)
        return [fitted(each, width) for each in (*heading, row((f" {self._news}", "good")))]

    def _level_rows(self) -> tuple[list[Row], list[Row]]:
        """The list of the chosen world with its map, and what is said of the chosen level."""
        level, levels = self.chosen.level, self._in_world(self.chosen.level.world)
        names, *listed = level_rows.world_levels(
            levels, level.id, self._references, self._rows("map").size.width
        )
        top, room, card = self._top_level, self._list_room, self._card_below()
        listed = [
            *self._world_heading([each.best_medal for each in levels]),
            names,
            *listed[top : top + room],
            *(
                [ladder_letters()] if len(card) <= self._rows_below_levels else []
            ),  # else its rule parts it from the list
            *card,
            *map_rows(levels, self._map_places(), self._pictures, level.id),
        ]
        width = (MAP_WIDTH if self._has_card else self.size.width) - 1  # beside the margin of the list
        if not self._has_thumbnail:
            about = level_rows.about(self.chosen, self._references[level.id], width, ABOUT_ROWS)
            return listed, [fitted(row(" ", *each), width + 1) for each in about]
        width -= level_rows.THUMBNAIL[0] + MARGIN
        about = level_rows.about(self.chosen, self._references[level.id], width, ABOUT_ROWS)
        picture = picture_rows(self._pictures.get(level.id, ()))
        return listed, side_by_side(
            [fitted(row(" ", *each), width + 1) for each in about], picture, width + 1 + MARGIN
        )

    @property
    def _has_thumbnail(self) -> bool:
        """Whether the chosen level's map stands beside what is said of it: no other picture of it is on the screen."""
        has_map = self.has_class("-wide") or any(place.rows for place in self._map_places())
        return self.size.width >= level_rows.WHOLE and self.chosen_challenge is None and not has_map

    @property
    def _has_card(self) -> bool:
        """Whether the chosen level's card stands beside its map."""
        return self.size.width >= ROOM_FOR_CARD and self.chosen_challenge is None

    def _card_beside(self) -> list[Row]:
        """The card of the chosen level: the rungs of each driver and where one stands among them, the stars, who is raced there,
        the sectors of one's best drive. Parts for which there is no room are left out whole."""
        level, best, width = self.chosen.level, self.chosen.best_times, CARD_WIDTH - 2 * MARGIN
        reference, company = self._references[level.id], company_of(self._known.get(level.id, ()))
        ladders = [
            [
                ruled_title("ladder", width, f"by {' or '.join(each.value for each in drivers)}"),
                *rung_rows(
                    drivers[0], reference, best.get(drivers[0]), ordinary=ordinary_drives(level, drivers)
                ),
            ]
            for drivers in drivers_by_ladder(best)
            if reference is not None
        ]
        parts = level_card(
            level, DriverKind.HAND, reference, self.chosen.rules, width, self.size.height, company
        )
        rows: list[Row] = []
        for part in (*ladders, *(parts[name] for name in CARD_PARTS if name in parts)):
            if len(rows) + len(part) <= self.size.height - ROWS_AROUND:
                rows += [*(row(" " * MARGIN, *each) for each in part), row()]
        return rows

    def _card_rows(self, width: int) -> list[Row]:
        """The chosen level's stars, and the sectors of one's best drive; none of a level without medals."""
        level = self.chosen.level
        if self._references[level.id] is None or width <= COLUMN:
            return []
        best = best_splits(self._known.get(level.id, ()))
        return stars_and_sectors(level, self.chosen.rules, best, width)

    def _card_below(self) -> list[Row]:
        """The card below the list, where it does not stand beside what is said of the level: its stars alone where there is no
        more room, none where there is none."""
        width, room = self._rows("map").size.width, self._rows_below_levels
        if self._has_card:
            return []
        rows = self._card_rows(width - 1)
        levels = self._in_world(self.chosen.level.world)
        with_line, with_rows = (map_places(levels, width, room - left) for left in (2, len(rows) + 1))
        shares = _richness(with_rows) >= _richness(with_line)
        if rows and len(rows) <= room and room > len(ExtraRule) and shares:
            return [*rows, row()]
        stars = star_line(self.chosen.level, self.chosen.rules)
        return [stars, row()][:room] if rows and room > 0 and row_width(stars) <= width else []

    @property
    def _rows_below_levels(self) -> int:
        """Rows of the list below the levels of the chosen world."""
        levels = self._in_world(self.chosen.level.world)
        return self._middle_rows - ROWS_ABOVE_LEVELS - len(levels) - 1

    def _challenge_rows(self, chosen: Challenge) -> tuple[list[Row], list[Row]]:
        """The list of challenges, beside it the chosen one's picture where there is room, and what is said of it."""
        medals = self._challenge_medals
        heading = self._world_heading([medals.get(each.id, Medal.NONE) for each in self._challenges])
        medal, width = medals.get(chosen.id, Medal.NONE), self.size.width  # the list has all of it, soon
        has_picture = width >= challenge_rows.ROOM_FOR_PICTURE
        column = challenge_rows.LIST_COLUMNS if has_picture else width
        about = challenge_rows.about_challenge(chosen, medal, column - 1)
        height = self.size.height - ROWS_AROUND - len(heading)
        is_beside = has_picture and len(self._challenges) + len(about) + 2 <= height
        self.set_class(is_beside, "-about-beside")
        listed = challenge_rows.challenge_list(
            self._challenges, medals, chosen.id, height if is_beside else self._list_room, column - 1
        )
        if has_picture:
            height = height if is_beside else self._middle_rows - len(heading)
            beside = min(width - column - 1, WIDEST_BESIDE) - MARGIN
            lesson = challenge_rows.lesson_below(chosen, beside, height) if is_beside else []
            picture = challenge_rows.challenge_picture(
                chosen, width - column - 1, height - len(lesson), self._theme.graph_glyphs
            )
            below = [row(), *about] if is_beside else []
            if is_beside:
                checks = challenge_events(self._progress, chosen)
                below += challenge_rows.challenge_standing(chosen, checks, column - 1)
                below = below[: height - len(listed)]
                picture += [row(" " * MARGIN, *each) for each in lesson]
            listed = side_by_side([*listed, *below], picture, column)
        else:
            column = challenge_rows.NARROW_LIST
            listed = side_by_side(listed, challenge_rows.small_picture(chosen, width - column), column)
        listed = [*heading, *listed]
        return listed, challenge_rows.about_challenge(chosen, medal, self.size.width - 1)

    @property
    def _list_room(self) -> int:
        """Rows for the list of levels or challenges."""
        return max(1, self._middle_rows - ROWS_ABOVE_LEVELS)

    @property
    def _top_level(self) -> int:
        """The number of the level of the chosen world that the list begins with."""
        levels = self._in_world(self.chosen.level.world)
        return challenge_rows.first_shown(len(levels), levels.index(self.chosen), self._list_room)

    def _doing_row(self) -> Row:
        share = self._prepared.get(self._doing_level, 0.0)
        return row((f"{self._doing}  ", "bold"), share_bar(share), f" {share:4.0%}")

    def _map_places(self) -> tuple[LevelPlace, ...]:
        """Where the levels of the chosen world stand below the list; none where the screen is too small."""
        if self.chosen_challenge is not None:
            return ()
        levels, size = self._in_world(self.chosen.level.world), self._rows("map").size
        return map_places(levels, size.width, self._rows_below_levels - len(self._card_below()))

    @work(exclusive=True, group="pictures")
    async def _draw_pictures(self) -> None:
        """The pictures of the chosen world's map, each in its turn, or the chosen level's."""
        wanted = [(each.level, (each.columns, each.rows)) for each in self._map_places() if each.rows]
        if self._has_thumbnail:
            wanted = [(self.chosen.level.id, level_rows.THUMBNAIL)]
        for name, (columns, rows) in wanted:
            picture = self._pictures.get(name, ())
            if (len(picture), *map(len, picture[:1])) != (rows, columns):
                level = next(each for each in self._levels if each.id == name)
                glyphs = self._theme.terminal.glyphs.value
                self._pictures[name] = await to_thread(picture_of, level, columns, rows, glyphs)
                self._show()

    def _in_world(self, world: str) -> list[LevelProgress]:
        return [each for each in self._found if each.level.world == world]

    @work(exclusive=True, group="ghosts")
    async def _load_ghosts(self) -> None:
        """The ghosts of the chosen level."""
        self._show()
        if self.chosen_challenge is not None:
            return
        level = self.chosen.level
        if self.has_class("-wide"):
            if level.id not in self._scenes:
                self._preview.clear()  # another level's map says nothing of this one
                self._scenes[level.id] = await to_thread(scene_of, level)
            self._preview.is_dim = not self.chosen.is_open
            self._preview.show(self._scene_with_ghosts(level))
        self._draw_pictures()
        if level.id not in self._known and self.chosen.is_open:
            await self._prepare_ghosts(level)
            self._show()
            if self.has_class("-wide"):
                self._preview.show(self._scene_with_ghosts(level))

    def _scene_with_ghosts(self, level: GameLevel) -> Scene:
        """The level's map with the ways of the ghosts that are known; in fog without."""
        ghosts = () if level.conditions.fog else self._known.get(level.id, ())
        return replace(
            self._scenes[level.id], paths=tuple(path for ghost in ghosts for path in ghost_paths(ghost))
        )

    async def _prepare_ghosts(self, level: GameLevel) -> None:
        """Makes the ghosts of a level known; who asks while they are being prepared waits for the same."""
        if level.id in self._known:
            return
        preparation = self._preparations.get(level.id)
        if preparation is None:
            preparation = self._preparations[level.id] = ensure_future(to_thread(self._ghosts_of, level))
            preparation.add_done_callback(lambda _: self._preparations.pop(level.id))
        self._known[level.id] = await shield(preparation)

    def _ghosts_of(self, level: GameLevel) -> tuple[Ghost, ...]:
        def note(share: float) -> None:
            self._prepared[level.id] = share

        return level_ghosts(self._workspace, level, note)

    # The mouse

    def on_row_clicked(self, event: RowClicked) -> None:
        """A level is chosen, in the list or on the map; a click on the chosen one opens it."""
        number = event.number - ROWS_ABOVE_LEVELS
        if event.rows.id != "map" or number < 0:
            return
        if self.chosen_challenge is not None:
            chosen, count = self._at - len(self._found), len(self._challenges)
            number += challenge_rows.first_shown(count, chosen, self._list_room)
            if number < count:
                self._choose_or_open(len(self._found) + number)
            return
        levels = self._in_world(self.chosen.level.world)
        if number + self._top_level < len(levels):
            clicked = levels[number + self._top_level]
        else:
            name = level_at(
                self._map_places(), event.column, number - len(levels) - 1 - len(self._card_below())
            )
            found = [each for each in levels if each.level.id == name]
            if not found:
                return
            clicked = found[0]
        self._choose_or_open(self._found.index(clicked))

    def _choose_or_open(self, number: int) -> None:
        if number == self._at:
            self.action_open()
        else:
            self._at = number
            self._load_ghosts()

    # Keys

    def action_choose(self, columns: int, rows: int) -> None:
        """The level this many rows below, or the first one this many worlds to the right."""
        if columns:
            world = self._worlds[(self._worlds.index(self._world) + columns) % len(self._worlds)]
            levels = self._in_world(world.id)
            self._at = self._found.index(levels[0]) if levels else len(self._found)
        else:
            self._at = max(0, min(self._at + rows, len(self._found) + len(self._challenges) - 1))
        self._load_ghosts()

    def action_help(self) -> None:
        self.app.push_screen(HelpDialog("Game", self.screen_actions, NOTES))

    @work(exclusive=True, group="drive")
    async def action_open(self) -> None:
        if self.chosen_challenge is not None:
            await self._open_challenges()
        elif self._may_drive():
            await self._drive(self.chosen.level)

    async def _open_challenges(self) -> None:
        """The chosen challenge, and after it the next one as long as the player wants it."""
        from kit.tui.screens.challenge import ChallengeScreen
        from kit.tui.screens.puzzle import PuzzleScreen

        while (challenge := self.chosen_challenge) is not None and self.is_active and not self._doing:
            title = next((each.title for each in self._challenges[self._at - len(self._found) + 1 :]), None)
            try:
                if not await self._agrees_to_clock(challenge):
                    return
                is_played = challenge.task.board("") is not None
                kind = PuzzleScreen if is_played else ChallengeScreen
                screen = kind(self._theme, challenge, self._progress, self._workspace, title)
            except (ProgressError, OSError) as error:
                self.app.push_screen(MessageDialog("The puzzle could not start", str(error)))
                return
            await self.app.push_screen_wait(screen)
            self._read()
            self._at += screen.wish == "next"
            self._load_ghosts()
            following = self.chosen_challenge
            # A repair's clock begins with the first look: nobody is taken there by the key for the next one.
            if screen.wish == "back" or (following and following.task.clock is not None):
                return

    async def _agrees_to_clock(self, challenge: Challenge) -> bool:
        """Whether a challenge may be opened, asked where its clock begins with that. Raises ProgressError."""
        if challenge.task.clock is None or not starts_clock(self._progress, challenge):
            return True
        gold_s, _ = challenge.task.clock
        choices = [
            PickerItem("open", "open it", f"the clock starts; gold until {gold_s:.0f} s"),
            PickerItem("leave", "not yet"),
        ]
        return await self.app.push_screen_wait(Picker(f"{challenge.title}: now?", choices)) == "open"

    @work(exclusive=True, group="drive")
    async def _drive_first(self, level: GameLevel) -> None:
        """The level that the screen was opened for."""
        if level not in self._levels or self._may_drive():
            await self._drive(level)

    @work(exclusive=True, group="drive")
    async def action_daily(self) -> None:
        """The challenge of the day, by hand."""
        if not self._doing and self.is_active:
            await self._drive(daily_level(today()))

    @work(exclusive=True, group="drive")
    async def action_two_players(self) -> None:
        from kit.tui.screens.two_players import play_together  # of no use to the first frame

        if self._may_drive():
            await play_together(self.app, self._theme, self.chosen.level, self._workspace, self._progress)

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
            Picker(f"Who drives? Yours are in {shell_path(self._workspace.controllers)}", choices)
        )
        if picked is not None:
            await self._drive(self.chosen.level, DriverKind.PROGRAM, files[picked])

    @work(exclusive=True, group="drive")
    async def action_agent(self) -> None:
        if not self._may_drive():
            return
        choices = await to_thread(agent_items, self._workspace.runs)
        picked: str | None = NEW_AGENT
        if choices:
            choices.append(PickerItem(NEW_AGENT, "a new one", "how to train one for this level"))
            picked = await self.app.push_screen_wait(Picker("Which agent drives?", choices))
        if picked == NEW_AGENT:
            title = f"An agent for {self.chosen.level.title}"
            self.app.push_screen(MessageDialog(title, level_rows.way_to_agent(self.chosen.level)))
        elif picked is not None:
            await self._drive_agent(picked)

    async def _drive_agent(self, name: str) -> None:
        from kit.learning.policies.policy import PolicyError
        from kit.learning.training.run_config import RunError
        from kit.learning.training.run_folders import find_run

        with ExitStack() as stack:
            try:
                run = await to_thread(find_run, self._workspace.runs, name)
                policy = await to_thread(run.policy)
                program = stack.enter_context(agent_controller(policy))
                facts = DriverFacts(training_steps=run.summary().steps)
            except (PolicyError, RunError, LookupError, ValueError, OSError) as error:
                self.app.push_screen(MessageDialog("The drive could not start", str(error)))
                return
            await self._drive(self.chosen.level, DriverKind.AGENT, program, facts, (run.name, policy))

    async def _drive(
        self,
        level: GameLevel,
        driver: DriverKind = DriverKind.HAND,
        program: ControllerFile | None = None,
        facts: DriverFacts = BY_HAND,
        agent: tuple[str, Policy] | None = None,
    ) -> None:
        """Shows a drive, and after it the next level where the player wants it."""
        from kit.tui.screens.level_drive import LevelDrive

        self._doing, self._doing_level = "Preparing the ghosts", level.id
        self._show()
        shown = self.set_interval(0.2, self._show)
        try:
            await self._prepare_ghosts(level)
        finally:
            shown.stop()
            self._doing = self._doing_level = ""
            self._show()
        screen = LevelDrive(
            self._theme,
            level,
            self._known[level.id],
            self._progress,
            self._workspace,
            driver=driver,
            program=program,
            facts=facts,
            agent=agent,
        )
        await self.app.push_screen_wait(screen)
        self._refresh_after_drive(level)
        if screen.has_given_up:
            self.app.push_screen(MessageDialog(f"{level.title}: given up", GIVEN_UP))
        if screen.wish != "next":
            return
        if level.id.startswith(DAILY_PREFIX):
            self.action_leaderboard()  # the board of the day
        elif (following := open_level_after(self._found, level)) is not None:
            self._at = self._levels.index(following)
            self._load_ghosts()
            await self._drive(self.chosen.level, driver, program, facts, agent)

    @work(exclusive=True, group="drive")
    async def action_replay(self) -> None:
        if self.chosen_challenge is not None:
            return
        level = self.chosen.level
        recordings: dict[str, Path | Recording] = {
            driver.phrase: file
            for driver in DriverKind
            if (file := ghost_file(self._workspace, level, driver)).is_file()
        }
        reference = await to_thread(reference_recording, level)
        if reference is not None and recordings:  # first it is driven, then the reference is shown
            recordings["reference"] = reference
        if not recordings:
            text = "w replays drives, and of this level none has finished yet. Enter drives it."
            self.app.push_screen(MessageDialog("Nothing to replay yet", text))
            return
        choices = [PickerItem(name, name, "") for name in recordings]
        picked = await self.app.push_screen_wait(Picker("Replay whose drive?", choices))
        if picked is not None:
            await self._replay(level, recordings[picked], picked)

    async def _replay(self, level: GameLevel, source: Path | Recording, who: str) -> None:
        from kit.tui.screens.lesson_drive import RecordingScreen

        try:
            recording = await to_thread(load_recording, source) if isinstance(source, Path) else source
        except (RecordingError, OSError) as error:
            self.app.push_screen(MessageDialog("This drive cannot be replayed", str(error)))
            return
        await self.app.push_screen_wait(
            RecordingScreen(self._theme, film_scenario(level, recording.seed), recording, who)
        )

    def action_back(self) -> None:
        """Gives up a drive that is being prepared; else leaves the list."""
        if not self._doing:
            super().action_back()
            return
        is_daily = self._doing_level.startswith(DAILY_PREFIX)
        self._news = level_rows.NOT_BEGUN[is_daily]
        self.workers.cancel_group(self, "drive")

    def action_leaderboard(self) -> None:
        self.app.push_screen(LeaderboardScreen(self._theme, self._progress, self._workspace))

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """While a drive is being prepared, nothing takes its place: a key that is pressed again would end it."""
        return not (self._doing and action in STARTS)

    def _may_drive(self) -> bool:
        if self._doing or not self.is_active or self.chosen_challenge is not None:
            return False
        if not self.chosen.is_open:
            level = self.chosen.level
            text = f"{level.title} {level_rows.opens_after(level)}."
            self.app.push_screen(MessageDialog("Not open yet", text))
            return False
        return True

    def _refresh_after_drive(self, level: GameLevel) -> None:
        """A drive has ended: medals and ghosts may be others now."""
        self._known.pop(level.id, None)
        self._read()
        self._load_ghosts()


def _richness(places: Sequence[LevelPlace]) -> tuple[bool, bool]:
    """Whether a map has places, and whether it has pictures."""
    return bool(places), bool(places and places[0].rows)
