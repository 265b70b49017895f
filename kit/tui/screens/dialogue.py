"""A dialogue on the full screen: its blocks in the middle, below them what is said to the last key, and the keys that work now."""

from __future__ import annotations

from asyncio import to_thread
from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, Final, cast

from textual import events, work
from textual.app import ComposeResult
from textual.containers import Horizontal, Vertical
from textual.geometry import Size

from kit.dialogue.actions import ScreenActions
from kit.dialogue.dialogue import Dialogue, Turn
from kit.dialogue.effects import Choose, Effect, Help, Leave, Open, Remark, Show, StartTyping, Tell, Work
from kit.document.blocks import Tone
from kit.document.layout import Page, place, rows_of
from kit.document.rows import MARGIN, Row, at_both_edges, fitted, row, text_width, window
from kit.school.lessons.graph_playback import graph_rows
from kit.school.lessons.records import GraphScene, LearningScene, LessonScene
from kit.tui.loop_calls import called_in_loop
from kit.tui.rows.key_rows import FOOTER_ROWS, footer
from kit.tui.rows.panel_rows import panel_rows
from kit.tui.screens.dialogs import HelpDialog
from kit.tui.screens.glossary import open_glossary
from kit.tui.screens.picker import Picker, PickerItem
from kit.tui.screens.text_screen import page_screen
from kit.tui.widgets.playback_scene_view import PlaybackSceneView
from kit.tui.widgets.text_rows import RowsScreen, TextRows
from kit.tui.widgets.world_view import WorldView

if TYPE_CHECKING:
    from kit.render.scene import Scene
    from kit.tui.app import KitApp
    from kit.tui.widgets.text_field import AnswerField

WIDEST: Final = 92
"""Columns of a question, however wide the terminal."""
BESIDE: Final = 42
WIDEST_BESIDE: Final = 76
"""Columns of the panels beside it, at least and at most."""
LEAST_BESIDE: Final = 76
"""A question keeps this many columns; where there are fewer nothing stands beside it."""
LEAST_ROWS_IN_MIDDLE: Final = 24
"""A screen with no more rows shows the question at its top."""
ROOMY_ROWS: Final = 36
"""A screen with no fewer rows has room for empty ones between choices."""
ROWS_AROUND: Final = 2 + FOOTER_ROWS
"""Rows of the heading, the remark and the keys."""
LEAST_PICTURE, MOST_PICTURE = 9, 25
"""Rows of the picture below the question; where there are fewer it is left out."""
ROWS_BELOW_PICTURE: Final = 12
"""Rows that it leaves free below it, where it has its least ones all the same."""
POLL_S: Final = 0.2
"""Seconds between two looks whether something has happened by itself."""
SCROLLS: Final = {
    "up": -1,
    "down": 1,
    "pageup": -10,
    "pagedown": 10,
    "space": 10,
    "home": -1000000,
    "end": 1000000,
}
"""Lines by which a key scrolls, where the dialogue has no other use for it."""
WHILE_TYPING: Final = {"enter", "escape"}
"""Keys that are not for the text while one is typed."""


def screen_actions_of(kind: type[Dialogue]) -> ScreenActions:
    """The actions of a dialogue as those of its screen, which has each key call ``press``."""
    declared = kind.screen_actions()
    has_arrows = any("up" in keys.split(",") for each in declared.records for keys, _ in each.bindings)
    more = (*declared.more, *(() if has_arrows else ("scroll",)))
    return ScreenActions(declared.name, declared.footer, more, own=declared.own)


class DialogueScreen(RowsScreen[None]):
    """Shows one dialogue. Draws nothing but what a key has changed."""

    AUTO_FOCUS = ""
    DEFAULT_CSS = """
    DialogueScreen { layout: vertical; }
    DialogueScreen #heading, DialogueScreen #remark, DialogueScreen #keys { height: 1; }
    DialogueScreen #keys { margin: 1 0 0 0; }
    DialogueScreen #middle, DialogueScreen #body, DialogueScreen #below { height: 1fr; }
    DialogueScreen #panels { width: 1fr; height: 1fr; }
    DialogueScreen #panels, DialogueScreen #below, DialogueScreen AnswerField { display: none; }
    DialogueScreen WorldView, DialogueScreen PlaybackSceneView { display: none; }
    """

    def __init__(self, dialogue: Dialogue) -> None:
        super().__init__()
        self.take(dialogue)

    def take(self, dialogue: Dialogue) -> None:
        """Shows this dialogue from now on."""
        self.dialogue = dialogue
        self.turn = Turn(dialogue)
        self.screen_actions = screen_actions_of(type(dialogue))
        self._field: AnswerField | None = None
        self._typed_place: object = self
        """The place whose text is in the field."""
        self._top = 0
        self._body_height: int | str = "1fr"
        self._world: WorldView | None = None
        self._playback: PlaybackSceneView | None = None
        """The two that show scenes; None: the dialogue has none."""
        self._shown_scene: object = None
        """The one that is shown, or will be."""
        self._kept_rows = 0
        self._kept_for: object = None
        """For which question, on a screen of which size, so many rows are kept for what is said of it."""
        self._placed: tuple[int, int, bool] | None = None
        """Columns of the question, rows of the picture and whether there are panels, as the screen was last laid out."""

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        with Horizontal(id="middle"):
            with Vertical(id="question"):
                yield TextRows(id="body")
                if self.dialogue.has_entry:
                    from kit.tui.widgets.text_field import AnswerField  # its library is slow to import

                    self._field = AnswerField()
                    yield self._field
                if self.dialogue.has_scenes:
                    theme = cast("KitApp", self.app).kit_theme
                    self._world = WorldView(lambda: theme.encoder, theme.palette)
                    self._playback = PlaybackSceneView(theme)
                    yield self._world
                    yield self._playback
                if self._field is not None or self._world is not None:
                    yield TextRows(id="below")
            yield TextRows(id="panels")
        yield TextRows(id="remark")
        yield TextRows(id="keys")

    def on_mount(self) -> None:
        if type(self.dialogue).poll is not Dialogue.poll:
            self.set_interval(POLL_S, self._poll)
        self._show_field()  # before the first frame, which would else be painted twice
        self.show_all()

    def on_unmount(self) -> None:
        self.dialogue.close()

    def on_resize(self, event: events.Resize) -> None:
        self.call_after_refresh(self.look_again)

    def look_again(self) -> None:
        """Shows everything in another size of the screen."""
        self.show_all()

    # What is shown

    @property
    def room(self) -> Size:
        """The size of the screen; before it has one that of the app, so that its first frame is whole."""
        return self.size if self.size.width else self.app.size

    def show(self) -> None:
        """Draws everything as it is now. Rows that have not changed cost nothing."""
        if not self.is_attached:
            return
        self._show_body()
        self._rows("heading").show([self._heading()])
        self._rows("remark").show([fitted(self._remark(), self.room.width)])
        self._rows("keys").show([self._keys()])

    def _show_body(self) -> None:
        whole, room = self._body(), self._body_room
        picture = self._fitting_picture(room - self._kept(whole))
        if picture:
            self._show_scene()
        self._lay_out(picture)
        self._show_field()
        is_typed = self._field is not None and self._field.display
        shown, self._top = window(whole, self._top, room)
        body = centred(shown, self.room.width, room, self._whole, is_at_top=self._has_panels)
        below = self._below(len(shown), picture)
        if not picture:
            body += below
        height = len(shown) if is_typed else self._kept(whole) if picture else "1fr"
        if height != self._body_height:  # setting a style lays out and paints the whole screen
            self._body_height = self._rows("body").styles.height = height
        self._rows("body").show(body)
        if picture:
            self._rows("below").show(below)
        if self._has_panels:
            beside = [each for each in self.dialogue.panels() if not each.is_below]
            self._rows("panels").show(panel_rows(beside, self._beside - MARGIN, room))

    def _kept(self, whole: Sequence[Row]) -> int:
        """Rows of the question, with those that are kept free for what may be said of it. ``whole``: as it is now."""
        shown_for = self.room, self.dialogue.place
        if shown_for != self._kept_for:
            possible = self.dialogue.possible_blocks() if self._has_panels else ()
            lengths = (len(rows_of(each, self._text_page)) + 1 for each in possible)
            self._kept_for, self._kept_rows = shown_for, max(lengths, default=0)
        return max(self._kept_rows, len(whole))

    def _below(self, used: int, picture: int) -> list[Row]:
        """What stands below the question, or below its picture: the figure and the panels that belong there. All panels where the
        screen has no columns for them, then at its bottom. ``used``: rows of the question."""
        dialogue, room = self.dialogue, self._body_room
        # The field stands below the question.
        if dialogue.entry is not None or not dialogue.has_panels:
            return []
        width = text_width(self.room.width, self._widest - 2 * MARGIN)
        # An empty row is above a remark that stands there always.
        room -= dialogue.note is not None
        if self._has_panels:
            kept = max(used, self._kept_rows)
            figure = dialogue.figure()
            panels = [each for each in dialogue.panels() if each.is_below]
            shown = panel_rows([*([figure] if figure else []), *panels], width, room - kept - picture)
            blank = 0 if picture else kept - used
        else:
            shown = panel_rows(dialogue.panels(), width, room - used - 1, upwards=True)
            blank = room - used - len(shown)
        indent = " " * (self._left + MARGIN)
        return [*[row()] * blank, *(row(indent, *each) if each else each for each in shown)] if shown else []

    def _lay_out(self, picture: int) -> None:
        """Gives the question, its picture and the panels their places, where these have changed."""
        has_panels = self._has_panels
        columns = self._left + self._widest if has_panels else self.room.width
        if self._placed == (columns, picture, has_panels):
            return
        self._placed = columns, picture, has_panels
        self.query_one("#question").styles.width = columns
        self._rows("panels").display = has_panels
        self._lay_out_scene(picture)

    def _lay_out_scene(self, rows: int) -> None:
        """Gives the picture its rows."""
        if self._world is None or self._playback is None:
            return
        for view, is_shown in ((self._playback, self._playback.scene is not None), (self._world, True)):
            view.display = is_shown and rows > 0
            view.styles.height = rows
            view.styles.margin = (0, MARGIN, 0, self._left + MARGIN)
            rows = 0 if is_shown else rows
        self._rows("below").display = self._placed is not None and self._placed[1] > 0

    def _show_scene(self) -> None:
        """Reads the scene that belongs to the question: what is played at once, a world in another thread."""
        scene = self.dialogue.scene_shown
        if self._world is None or self._playback is None or scene == self._shown_scene:
            return
        self._placed, self._shown_scene = None, scene
        self._playback.close_session()
        if isinstance(scene, LessonScene):
            self._read_world(self._world, scene)
        elif isinstance(scene, LearningScene | GraphScene):
            self._playback.open(scene, still=True)

    @work(exclusive=True, group="scene")
    async def _read_world(self, picture: WorldView, scene: LessonScene) -> None:
        picture.show(await to_thread(scene_of_place, scene))

    def _body(self) -> list[Row]:
        return [row(), *rows_of(self.dialogue.blocks(), self._text_page)]

    @property
    def _body_room(self) -> int:
        return max(1, self.room.height - ROWS_AROUND)

    def _fitting_picture(self, left: int) -> int:
        """Rows of the picture below the question; 0 where there is no room. ``left``: rows that nothing is said in."""
        scene = self.dialogue.scene_shown if self._has_panels else None
        if isinstance(scene, GraphScene):
            rows = len(graph_rows(scene, at_end=False))
            return rows if rows + ROWS_BELOW_PICTURE <= left else 0
        rows = min(MOST_PICTURE, max(left - ROWS_BELOW_PICTURE, LEAST_PICTURE))
        return rows if scene is not None and rows <= left else 0

    @property
    def _has_panels(self) -> bool:
        return self.room.width >= LEAST_BESIDE + BESIDE and self.dialogue.has_panels

    @property
    def _beside(self) -> int:
        """Columns of the panels."""
        return max(BESIDE, min(WIDEST_BESIDE, self.room.width - WIDEST - MARGIN)) if self._has_panels else 0

    @property
    def _whole(self) -> int:
        """Columns of the question and of what stands beside it."""
        return self._widest + self._beside

    @property
    def _widest(self) -> int:
        """Columns of the question."""
        return min(WIDEST, self.room.width - self._beside) if self._has_panels else WIDEST

    @property
    def _left(self) -> int:
        """The column at which the question begins."""
        return left_column(self.room.width, self._whole)

    @property
    def _text_page(self) -> Page:
        is_roomy = self.room.height - ROWS_AROUND >= ROOMY_ROWS
        return Page(text_width(self.room.width, self._widest - 2 * MARGIN), MARGIN, is_roomy=is_roomy)

    def _show_field(self) -> None:
        """The field in which a text is typed, with the text of this place."""
        field, entry = self._field, self.dialogue.entry
        if field is None:
            return
        if field.display != (entry is not None):
            field.display = self._rows("below").display = entry is not None
        if entry is None:
            self._typed_place = self
            return
        left = self._left + MARGIN
        columns = self._left + self._widest if self._has_panels else self.room.width
        right = max(0, columns - left - text_width(self.room.width, self._widest - 2 * MARGIN))
        field.styles.margin = (0, right, 0, left)
        if self._typed_place != self.dialogue.place:
            self._typed_place = self.dialogue.place
            field.load_text(entry)
            field.move_cursor(field.document.end)
            self.set_focus(None if entry else field)
        elif field.answer != entry and not self._is_typing:
            field.load_text(entry)

    @property
    def _is_typing(self) -> bool:
        """Whether keys are for the text."""
        return self._field is not None and self.focused is self._field

    def _heading(self) -> Row:
        title = row((self.dialogue.title, "title"))
        position = self.dialogue.position
        return at_both_edges(title, row((position, "dim")), self.room.width) if position else title

    def _remark(self) -> Row:
        margin = MARGIN + (self._left if self._has_panels else 0)
        if self.turn.remark is not None:
            return row((" " * margin + self.turn.remark.text, self.turn.remark.tone))
        note = self.dialogue.note
        return row() if note is None else rows_of([note], Page(1000, margin))[0]

    def _keys(self) -> Row:
        dialogue, possible = self.dialogue, {each.id: each for each in self.turn.possible()}
        is_typing = self._is_typing
        without = {
            each
            for each in self.screen_actions.footer
            if each not in possible or (is_typing and not WHILE_TYPING & possible[each].keys.key_names)
        }
        labels = {each.id: each.word(dialogue) for each in possible.values() if each.word is not None}
        if is_typing:
            labels["back"] = "stop typing"
        keys = {
            each.id: each.shown_keys(dialogue) for each in possible.values() if each.shown_keys is not None
        }
        return footer(self.screen_actions, self.room.width, without=without, labels=labels, keys=keys)

    @property
    def unavailable_actions(self) -> list[str]:
        possible = {each.id for each in self.turn.possible()}
        return [each.id for each in self.dialogue.actions if each.id not in possible]

    def show_all(self) -> None:
        """Shows everything, and brings what was just said into sight."""
        look, self._top = self.dialogue.block_in_view, 0
        if look is not None:
            blocks = list(self.dialogue.blocks())
            placed = place(blocks, self._text_page)
            last_top = max(0, len(placed.rows) + 1 - self._body_room)
            self._top = min(placed.starts[blocks.index(look)] + 1, last_top)  # an empty row begins the page
        self.show()

    # Keys

    def on_key(self, event: events.Key) -> None:
        if self._is_typing or not self.takes_key(event.key):
            return
        if self.turn.find(event.key) is not None:
            event.stop()
            event.prevent_default()
            self.action_press(event.key)
        elif event.key in SCROLLS:
            event.stop()
            self.action_scroll(SCROLLS[event.key])

    def takes_key(self, key: str) -> bool:
        """Whether a key is the dialogue's."""
        return True

    def action_press(self, key: str) -> None:
        """Does what a key of the dialogue means. The glossary is not a page of it here, but the screen that it is everywhere."""
        found, effect = self.turn.find(key), self.turn.press(key)
        if found is not None and found[0].id == "glossary" and isinstance(effect, Tell):
            self.show_all()
            open_glossary(self.app)
        else:
            self._perform(effect)

    def action_scroll(self, lines: int) -> None:
        self._top += lines
        self.show()

    def _poll(self) -> None:
        was_busy, remark = bool(self.dialogue.busy), self.turn.remark
        effect = self.turn.attempt(self.dialogue.poll)
        is_busy = bool(self.dialogue.busy)
        if was_busy == is_busy:  # what was said to the last key still stands
            self.turn.remark = self.turn.remark or remark
        if effect is not None or (was_busy and not is_busy):
            self._perform(effect)
        elif is_busy:
            self.show()

    def _perform(self, effect: Effect) -> None:
        """Carries out what an action has led to."""
        match effect:
            case None | Remark():
                self.show_all()
            case Leave():
                self.action_back()
            case Help():
                self._show_help()
            case StartTyping():
                if self._field is not None:
                    self.set_focus(self._field)
                self.show()
            case _:
                self.show()
                self._carry_out(effect)

    @property
    def help_notes(self) -> Sequence[Sequence[tuple[str, str]]]:
        """Blocks of keys, signs or terms, and what they mean, below the dialogue's keys."""
        return self.dialogue.help_notes

    def _show_help(self) -> None:
        # What does nothing yet is on the page all the same: it says what there is. But no key is there twice.
        self.app.push_screen(
            HelpDialog(
                self.dialogue.help_title,
                self.screen_actions,
                *self.help_notes,
                without=[each.id for each in self.turn.hidden_by_others()],
            )
        )

    @work
    async def _carry_out(self, effect: Effect) -> None:
        """What takes a while, or another screen; then what follows from it."""
        follows: Callable[[], Effect] = _no_effect
        match effect:
            case Tell(title, blocks):
                await self.app.push_screen_wait(page_screen(title, blocks))
            case Choose(title, options, then, selected):
                items = [PickerItem(str(at), name, text) for at, (name, text) in enumerate(options)]
                chosen = await self.app.push_screen_wait(Picker(title, items, str(selected)))
                follows = partial(then, None if chosen is None else int(chosen))
            case Open(dialogue, then):
                await self.app.push_screen_wait(self.screen_for(dialogue))
                follows = then
            case Work(note, job, then):
                if note:
                    self._say_of_work(note)
                result: list[Any] = []
                tell = called_in_loop(self._say_of_work)
                failed = await to_thread(self.turn.attempt, lambda: result.append(job(tell)))
                if failed is not None or not result:
                    self._perform(failed)
                    return
                follows = partial(then, result[0])
            case Show(request, then):
                follows = partial(then, await self.show_request(request))
        if self.is_mounted:
            self._perform(self.turn.attempt(follows))

    def _say_of_work(self, text: str) -> None:
        if self.is_mounted:
            self.turn.set_remark(Remark(text, Tone.DIM))
            self.show()

    def screen_for(self, dialogue: Dialogue) -> DialogueScreen:
        """The screen of a dialogue that is opened from this one."""
        return DialogueScreen(dialogue)

    async def show_request(self, request: object) -> Any:
        """Shows what the dialogue asks its face to show; returns what came of it."""
        raise NotImplementedError(type(request).__name__)

    # The field

    def on_answer_entered(self) -> None:
        self.action_press("enter")

    def on_editor_left(self) -> None:
        self.set_focus(None)
        self.show()

    def on_text_area_changed(self) -> None:
        if self._field is not None and self._typed_place == self.dialogue.place:
            self.dialogue.take_draft(self._field.answer)
            self.show()


def _no_effect() -> Effect:
    return None


def scene_of_place(scene: LessonScene) -> Scene:
    """The world of a scene before anybody drives. Takes a while: not to be called by what draws."""
    from kit.run.scenario import find_scenario  # of no use to the first frame
    from kit.tui.screens.level_pictures import first_scene

    return first_scene(find_scenario(scene.map_name, scene.case))


def centred(
    rows: Sequence[Row], width: int, room: int, widest: int = WIDEST, *, is_at_top: bool = False
) -> list[Row]:
    """The rows as a column in the middle of a wide screen, lower on a high one if not ``is_at_top``. The place depends on
    the screen alone: nothing moves as rows are added.

    >>> centred([row("one")], 100, 20)
    [(('    ', ''), ('one', ''))]
    """
    left = left_column(width, widest)
    above = 0 if is_at_top else max(0, min((room - LEAST_ROWS_IN_MIDDLE) // 3, room - len(rows)))
    return [row()] * above + [(row(" " * left) + each if left and each else each) for each in rows]


def left_column(width: int, widest: int = WIDEST) -> int:
    """The column at which ``centred`` begins."""
    return max(0, (width - widest) // 2)
