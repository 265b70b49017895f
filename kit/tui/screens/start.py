"""The start screen: a robot in its maze, to be driven with W, A, S and D, and beside it everything there is."""

from __future__ import annotations

from asyncio import Event, get_running_loop, to_thread
from collections.abc import Awaitable, Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import cache, partial
from typing import TYPE_CHECKING, Any, ClassVar, Final

from textual import work
from textual.binding import BindingType
from textual.screen import Screen

from kit.dialogue.actions import ScreenActions
from kit.dialogue.screen_action import ScreenAction
from kit.document.rows import Row, at_both_edges, row
from kit.inspection.sockets import sockets_folder
from kit.tui.input.drive import DriveState
from kit.tui.input.drive_keys import base_key
from kit.tui.loop_calls import called_in_loop
from kit.tui.rows.key_rows import bindings
from kit.tui.rows.menu_rows import (
    MENU,
    MENU_KEYS,
    PANEL_WIDTH,
    PICTURE,
    PICTURE_ROWS,
    WIDE_PANEL,
    menu,
)
from kit.tui.screens.dialogs import MessageDialog
from kit.tui.screens.palette import PaletteCommand
from kit.tui.screens.play import TELEOP, PlayScreen
from kit.tui.screens.watch import BREAKPOINTS
from kit.tui.student_store import StudentOverview, StudentStore
from kit.tui.theme import Theme
from kit.tui.widgets.text_rows import TextRows

if TYPE_CHECKING:
    from kit.run.view import View
    from kit.school.game.challenge import Challenge
    from kit.school.game.levels import GameLevel
    from kit.school.lessons.glossary import GlossaryTerm
    from kit.school.lessons.records import Lesson
    from kit.school.progress import ProgressJournal


DRIVING_LETTERS = ("w", "a", "s", "d")
NEWS_S: Final = 30.0
"""For so long it is told what is new [s]."""
VAST: Final = 190
"""Columns from which on the robot's picture leaves room for a wide panel."""
WITH_VAST: Final = [*BREAKPOINTS, (VAST, "-vast")]
PLACE, CONTROLLER = "maze", "random_walk"
PARTS_OF_GAME: Final = {"daily": "daily race", "two_players": "multiplayer", "leaderboard": "records"}
"""Actions of the game's screen that the palette lists too, and other words by which it finds them."""


class StartScreen(PlayScreen, inherit_bindings=False):
    """W, A, S and D drive, up and down choose in the menu; what the menu opens comes back here."""

    has_instruments = False
    help_title = "The start screen"
    help_notes = ((("Esc", "returns to this screen"),),)

    screen_actions = ScreenActions(
        "start",
        ("open", "line", "choose_line", "drive_letters", "help", "quit"),
        ("hand_over", "restart", "drive_mode"),
        own=(
            ScreenAction("choose_line", "↑↓ Tab", "choose", "move to the next or previous line of the menu",
                   (("down,tab", "choose(0, 1)"), ("up,shift+tab", "choose(0, -1)"))),
            ScreenAction("line", "1 to 9 l", "open", "open that line of the menu",
                   tuple((key, f"open({number})") for number, key in enumerate(MENU_KEYS)), "1-9"),
            ScreenAction("drive_letters", "W A S D", "drive", "drive the robot in the picture", (), "WASD"),
        ),
    )  # fmt: skip
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)
    DEFAULT_CSS = f"""
    StartScreen #panel {{ width: {PANEL_WIDTH}; }}
    StartScreen.-narrow #panel {{ display: block; }}
    StartScreen.-vast #panel {{ width: {WIDE_PANEL}; }}
    """
    HORIZONTAL_BREAKPOINTS = WITH_VAST

    def __init__(self, theme: Theme, store: StudentStore, *, seed: int = 0) -> None:
        workspace = store.workspace
        socket_dir = sockets_folder(workspace.folder)
        super().__init__(
            theme,
            PLACE,
            CONTROLLER,
            folder=workspace.controllers,
            runs=workspace.runs,
            seed=seed,
            socket_dir=socket_dir,
        )
        self._store = store
        self._reading = ThreadPoolExecutor(1)
        """Not the event loop's own, for whose work leaving would wait."""
        self._overview: StudentOverview | None = None
        """As last read; shown until it is read again."""
        self._is_outdated = True
        """Whether it may have changed since: whoever is away works."""
        self._level_picture: tuple[str, ...] = ()
        """Rows of the next level's picture, once it is drawn."""
        self._chosen = 0
        self._told: tuple[StudentOverview | None, int, int, int, tuple[str, ...]] | None = None
        """What the menu tells, as it is shown."""
        self._is_reading = self._is_away = False
        self._news = ""
        self._is_news_shown = False

    def on_mount(self) -> None:
        self._show_menu()
        # At the latest; at the best, when the robot is on the screen and the processor is free.
        self.set_timer(4.0, self._read_once)

    def on_unmount(self) -> None:
        self.release()

    def release(self) -> None:
        """Closes the student's files."""
        self._reading.shutdown(wait=False, cancel_futures=True)
        self._store.close()

    def is_drive_key(self, key: str) -> bool:
        return base_key(key) in DRIVING_LETTERS

    def open_world(self) -> None:
        self.host.open(self._find, self._controller, paused=self._theme.terminal.reduce_motion.value)

    def drive_keys_changed(self, messages: tuple[str, ...], state: DriveState) -> None:
        super().drive_keys_changed(messages, state)
        if messages and self._theme.terminal.reduce_motion.value:
            self.host.set_paused(False)

    def action_hand_over(self) -> None:
        super().action_hand_over()
        self.host.set_paused(False)

    def on_view_changed(self) -> None:
        self._read_once()

    # What is shown

    def _show(self) -> None:
        view = self.view
        self._show_menu()
        if view is None or not self.is_current or self._is_away or not self.query(TextRows):
            return
        self.world.offer(self._newest_scene)
        self._rows("heading").show([self._heading(view)])
        self._rows("messages").show(self.message_rows(view) or self._news_rows())

    def _news_rows(self) -> list[Row]:
        """What is new, until it was in sight for a while or something is opened after it was seen."""
        if self._news and not self._is_news_shown:
            self._is_news_shown = True
            self.set_timer(NEWS_S, self._forget_news)
        return [row((f" {self._news}", "good"))] if self._news else []

    def _forget_news(self) -> None:
        if self._is_news_shown:
            self._news = ""
            self._show()

    def _heading(self, view: View) -> tuple[tuple[str, str], ...]:
        driver = "you drive" if view.controller == TELEOP else "a program drives: random walk"
        if view.controller is None and self.driver_name:
            driver = f"it drives {self.driver_name}"
        if view.failure is not None:
            driver = "no program drives"
        return at_both_edges(
            row(("The terminal robot-learning kit", "title")), row((driver, "dim")), self.size.width
        )

    def _show_menu(self) -> None:
        if not self.query(TextRows):  # the kit is left while the rest is read
            return
        panel = self._rows("panel")
        size = panel.size  # without its padding
        columns = WIDE_PANEL if self.has_class("-vast") else PANEL_WIDTH
        told = self._overview, self._chosen, size.height, columns, self._level_picture
        if told != self._told:  # not once a frame
            self._told = told
            panel.show(menu(*told))

    def on_resize(self) -> None:  # besides the base class's, which Textual calls too
        self.call_after_refresh(self._show_menu if self._level_picture else self._fill_room)

    # Where the student stands

    def _read_once(self) -> None:
        if not self._is_reading and self._overview is None:
            self._is_reading = True
            self._read()

    @work(exclusive=True, group="overview")
    async def _read(self) -> None:
        await self._refresh_overview()

    async def _current_overview(self) -> StudentOverview:
        if self._overview is None or self._is_outdated:
            return await self._refresh_overview()
        return self._overview

    async def _refresh_overview(self) -> StudentOverview:
        """Read again, and shown."""
        loop, tell_part = get_running_loop(), called_in_loop(self._show_part)
        overview = await loop.run_in_executor(self._reading, self._store.read_overview, tell_part)
        self._overview, self._is_outdated = overview, False
        self._news = overview.news or self._news
        await self._draw_level_picture()
        if notice := self._store.take_notice():
            self.app.push_screen(MessageDialog("Your progress", notice))
        self._show()
        return overview

    async def _draw_level_picture(self) -> None:
        """Draws the next level, where there is room for it."""
        level = None if self._overview is None else self._overview.next_level
        if level is not None and self.has_class("-vast"):
            self._level_picture = await get_running_loop().run_in_executor(
                self._reading, _picture_of, level, self._theme.terminal.glyphs.value
            )

    @work(exclusive=True, group="picture")
    async def _fill_room(self) -> None:
        await self._draw_level_picture()
        self._show_menu()

    def _show_part(self, known: StudentOverview) -> None:
        """Shows what was won, where to go on, and whether today's maze was driven before the rest is known, which stays as it
        was."""
        if self._overview is None or known.is_whole:
            self._overview = known
        elif not known.problem:
            self._overview = replace(
                self._overview,
                shelf=known.shelf,
                going_on=known.going_on,
                streak=known.streak,
                has_run_today=known.has_run_today,
            )
        self._show()

    # Keys

    def action_choose(self, columns: int, rows: int) -> None:
        self._chosen = (self._chosen + rows) % len(MENU)
        self._show_menu()

    @work(exclusive=True, group="menu")
    async def action_open(self, number: int | None = None) -> None:
        """A line of the menu; by default the one that is chosen."""
        if not self.is_active:
            return
        self._chosen = self._chosen if number is None else number
        self._show_menu()
        item = MENU[self._chosen]
        await self._tell_opening(item.title)
        try:
            await getattr(self, f"_open_{item.name}")()
        finally:
            self._notice = None

    async def _tell_opening(self, title: str) -> None:
        """Says on the screen what is opened: what that needs may have to be loaded first."""
        self._show_notice(row((f"Opening {title} ...", "dim")))
        shown = Event()
        self.call_after_refresh(shown.set)
        await shown.wait()

    def _show_notice(self, notice: Row | None) -> None:
        self._notice = notice
        self._rows("messages").show([] if notice is None else [notice])

    async def palette_commands(self) -> list[PaletteCommand]:
        """Lines of the menu, lessons, levels and maps, each opened in place of whatever is open above; and the glossary's terms."""
        from kit.school.game.challenges import all_challenges
        from kit.school.game.levels import all_levels
        from kit.school.lessons.reading import lesson_number
        from kit.world.catalogue import all_maps

        overview = await self._current_overview()
        from kit.tui.screens.levels import LevelsScreen

        of_game = {each.id: each for each in LevelsScreen.screen_actions.own}
        levels, puzzles = await to_thread(all_levels), await to_thread(all_challenges)
        terms = await to_thread(_glossary)
        return [
            *(
                self._place(item.title, item.about, getattr(self, f"_open_{item.name}"), item.words)
                for item in MENU
            ),
            *(
                self._place(
                    of_game[name].label.capitalize(),
                    of_game[name].help,
                    partial(self._open_levels, None, name),
                    words,
                )
                for name, words in PARTS_OF_GAME.items()
            ),
            self._place(
                "Key test",
                "press keys and see what arrives on this terminal",
                self._open_key_test,
                "settings keyboard",
            ),
            *(
                self._place(f"Lesson {entry.number}", entry.title, partial(self._open_lesson, entry.lesson))
                for entry in overview.shelf
                if entry.lesson is not None
            ),
            *(self._place(f"Level {level.title}", "", partial(self._open_levels, level)) for level in levels),
            *(self._place(f"Puzzle {each.title}", "", partial(self._open_levels, each)) for each in puzzles),
            *(
                self._place(f"Map {card.name}", card.summary, partial(self._open_drive, card.name))
                for card in all_maps()
            ),
            *(
                PaletteCommand(
                    f"Term {each.term}",
                    f"its meaning; lesson {lesson_number(each.lesson)} introduces it",
                    partial(self._show_term, each),
                    " ".join(each.also).casefold(),
                )
                for each in terms
            ),
        ]

    async def _show_term(self, term: GlossaryTerm) -> None:
        """Above whatever is open, like the glossary itself."""
        from kit.tui.screens.glossary import open_glossary

        open_glossary(self.app, term)

    def _place(
        self, name: str, about: str, open_it: Callable[[], Awaitable[None]], words: str = ""
    ) -> PaletteCommand:
        """Opens it above this screen, which comes in place of all others where it is not shown yet."""
        app = self.app

        async def run() -> None:
            if not self.is_attached:
                while len(app.screen_stack) > 1:
                    await app.pop_screen()
                await app.push_screen(self)
            self._open_from_palette(open_it)

        return PaletteCommand(name, about, run, words, is_place=True)

    @work(exclusive=True, group="menu")
    async def _open_from_palette(self, open_it: Callable[[], Awaitable[None]]) -> None:
        """Leaves what is open above this screen; whoever waited for it is cancelled, being of the same group."""
        was_away = self._is_away
        while self.app.screen is not self:
            await self.app.pop_screen()
        if was_away:
            await self._reopen_own_world()
        await open_it()

    async def _open_then_return(self, screen: Screen[Any]) -> None:
        """Opens a screen in place of this one, and comes back to the robot at its start."""
        self._close_own_world()
        await self.app.push_screen_wait(screen)
        await self._reopen_own_world()

    def _close_own_world(self) -> None:
        self.stop_driving()
        self._is_away = self._is_outdated = True
        self._forget_news()
        self._show_notice(None)
        self.host.close_session()  # one world at a time

    async def _reopen_own_world(self) -> None:
        self._is_away = False
        self.open_world()
        await self._refresh_overview()

    async def _open_next_lesson(self) -> None:
        overview = await self._current_overview()
        if overview.problem:
            self.app.push_screen(MessageDialog("Progress cannot be read", overview.problem))
            return
        entry = overview.going_on
        if entry is None or entry.lesson is None:
            await self._open_lessons()
            return
        await self._open_lesson(entry.lesson)

    async def _open_lesson(self, lesson: Lesson) -> None:
        from kit.school.progress import ProgressError
        from kit.tui.screens.lesson import LessonScreen  # of no use to the first frame, like all below

        try:
            session = self._store.open_lesson(lesson)
        except ProgressError as error:
            self.app.push_screen(MessageDialog("Progress cannot be saved", str(error)))
            return
        await self._open_then_return(LessonScreen(self._theme, session, self._store.workspace))

    async def _open_lessons(self) -> None:
        from kit.tui.screens.lessons import LessonsScreen

        overview = await self._current_overview()
        if overview.problem:
            self.app.push_screen(MessageDialog("Progress cannot be read", overview.problem))
        else:
            await self._open_then_return(LessonsScreen(self._theme, self._store, overview))

    async def _open_drive(self, place: str = PLACE) -> None:
        workspace = self._store.workspace
        await self._open_then_return(
            PlayScreen(
                self._theme,
                place,
                CONTROLLER,
                folder=workspace.controllers,
                runs=workspace.runs,
                socket_dir=sockets_folder(workspace.folder),
            )
        )

    async def _open_levels(self, first: GameLevel | Challenge | None = None, action: str = "") -> None:
        from kit.school.progress import ProgressError
        from kit.tui.screens.levels import LevelsScreen

        try:
            journal = await to_thread(self._store.progress)
            screen = LevelsScreen(self._theme, journal, self._store.workspace, first, action)
        except (ProgressError, FileNotFoundError) as error:
            self.app.push_screen(MessageDialog("The levels cannot be opened", str(error)))
            return
        await self._open_then_return(screen)

    async def _open_key_test(self) -> None:
        from kit.tui.screens.key_test import KeyTestScreen

        await self._open_then_return(KeyTestScreen(self._theme.terminal))

    async def _open_train(self) -> None:
        from kit.tui.screens.trainings import TrainingsScreen

        await self._open_then_return(TrainingsScreen(self._theme, self._store.workspace.runs))

    async def _open_layers(self) -> None:
        from kit.layers.case_sources import open_task
        from kit.tui.screens.layers import LayersScreen

        await self._open_then_return(
            LayersScreen(self._theme, open_task("two"), "two", saved_to=self._store.workspace.worlds)
        )

    async def _open_league(self) -> None:
        from kit.school.game.league.entries import LeagueError
        from kit.school.game.league.league import own_league
        from kit.tui.screens.league import LeagueScreen

        workspace = self._store.workspace
        try:
            league = await to_thread(own_league, workspace)
        except LeagueError as error:
            self.app.push_screen(MessageDialog("The league cannot be opened", str(error)))
            return
        await self._open_then_return(LeagueScreen(self._theme, league, workspace))

    async def _open_quiz(self) -> None:
        from kit.tui.screens.quiz import choose_questions

        await self._open_with_journal(choose_questions)

    async def _open_form(self) -> None:
        from kit.tui.screens.form import ask_form

        await self._open_with_journal(ask_form)

    async def _open_with_journal(
        self, open_it: Callable[[Screen[Any], ProgressJournal], Awaitable[None]]
    ) -> None:
        """Opens what reads and writes the student's journal."""
        from kit.school.progress import ProgressError

        try:
            journal = await to_thread(self._store.progress)
        except ProgressError as error:
            self.app.push_screen(MessageDialog("Progress cannot be read", str(error)))
            return
        self._close_own_world()
        await open_it(self, journal)
        await self._reopen_own_world()

    async def _open_progress(self) -> None:
        from kit.tui.screens.progress import show_progress

        self._close_own_world()
        await show_progress(self, self._store)
        await self._reopen_own_world()


@cache
def _glossary() -> tuple[GlossaryTerm, ...]:
    """All terms; none where they cannot be read, which the glossary's own screen tells."""
    from kit.school.lessons.glossary import read_glossary
    from kit.world.problems import WorldError

    try:
        return read_glossary()
    except (WorldError, FileNotFoundError):
        return ()


def _picture_of(level: GameLevel, glyphs: str) -> tuple[str, ...]:
    from kit.tui.screens.level_pictures import picture_of  # of no use to the first frame

    return tuple(picture_of(level, PICTURE - 1, PICTURE_ROWS, glyphs))
