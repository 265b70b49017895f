"""The middle of a lesson's screen: its scene first, the words below or beside it, what is asked always in sight."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum
from typing import Final

from textual.app import ComposeResult
from textual.containers import Container
from textual.widget import Widget

from kit.dialogue.dialogue import Panel
from kit.document.rows import MARGIN, TEXT_WIDTH, Row, fitted, lines_shown, row, row_width
from kit.tui.rows.panel_rows import panel_rows
from kit.tui.widgets.lesson_scene_view import LessonSceneView
from kit.tui.widgets.playback_scene_view import PlaybackSceneView
from kit.tui.widgets.text_rows import TextRows

LEAST_PICTURE: Final = 8
MOST_PICTURE: Final = 14
"""Rows of a scene above the words."""
LEAST_WORDS: Final = 3
"""Rows of the words below it, on the smallest screen."""
LEAST_FILE: Final = 4
"""Rows of the student's file below the words; where fewer are left it is not shown."""
LINES_SEEN: Final = 2
"""Rows of a verdict or a hint that are brought into sight."""
BESIDE: Final = (62, 82)
"""Columns of the words, where the picture is beside them: at least, and at most."""
LEAST_BESIDE: Final = 110
"""Columns of the picture or the file, before the words get more than they need."""

ROOMY_SIZE: Final = (120, 30)
"""Columns and rows from which on the scene, the file and its log stand beside the words, all at once."""
LEAST_ASIDE: Final = 36
"""Columns of the panels beside the words, at least."""
COLUMNS_WIDTH: Final = 180
"""Columns from which on the file has a column of its own."""
MOST_LOG: Final = 8
"""Rows of what the program printed."""


def words_beside(columns: int) -> int:
    """The columns of the words on a page of so many, where the picture is beside them.

    >>> words_beside(120), words_beside(200)
    (62, 82)
    """
    return min(columns, max(BESIDE[0], min(columns - LEAST_BESIDE, BESIDE[1])))


class PageLayout(Enum):
    """The places of the page's parts."""

    STACKED = "-stacked"
    """The picture above the words."""
    BESIDE = "-beside"
    """The picture beside the words."""
    ROOMY = "-roomy"
    """The scene, the file and its log beside the words."""

    @classmethod
    def of(cls, width: int, height: int, *, is_wide: bool) -> PageLayout:
        """Computes the layout for a screen of this many columns and rows."""
        if width >= ROOMY_SIZE[0] and height >= ROOMY_SIZE[1]:
            return cls.ROOMY
        return cls.BESIDE if is_wide else cls.STACKED


@dataclass(frozen=True, slots=True)
class LessonContent:
    """The contents of a lesson's page."""

    words: Sequence[Row]
    asked: Sequence[Row] = ()
    """Below the words, always in sight."""
    picture: Sequence[str] = ()
    """Fixed characters, in place of a scene."""
    moves: LessonSceneView | PlaybackSceneView | None = None
    """The scene that is seen, if any."""
    is_backdrop: bool = False
    """Whether nothing moves in it: it is seen where the file leaves room for it."""
    moves_rows: int = 0
    """Rows that the scene has a use for; 0: as many as there are."""
    first_words: int = 0
    """Rows of words that the picture leaves room for, as far as it can."""
    most_words: int = 0
    """Rows of words there may be in this step: that many are kept free above what is asked, so that it never moves."""
    scrolls_with: str = "down"
    """The key that shows more words."""
    file: Sequence[Row] = ()
    """The student's file, line by line; shown where there is room."""
    words_width: int = BESIDE[0]
    """Columns of the words, where something stands beside them."""
    file_title: str = ""
    file_line: int = 0
    """The line of it to look at first, counted from 0."""
    aids: Sequence[Panel] = ()
    """Below the file, as far as it leaves room; where it stands below a scene, below the words."""
    log: Sequence[Row] = ()
    """What the student's program printed."""
    panels: Sequence[Panel] = ()
    """What a roomy page has where the words leave room: below them, or beside them where nothing else is."""
    page_width: int = 0
    """Columns of the page."""


class LessonPage(Container):
    """``scenes``: are opened and shut by whoever owns the sheet; one of them is seen at a time."""

    DEFAULT_CSS = """
    LessonPage { height: 1fr; layout: vertical; }
    LessonPage #left, LessonPage #stage { height: auto; layout: vertical; }
    LessonPage #picture { height: auto; }
    LessonPage #words { height: 1fr; }
    LessonPage #ask { height: auto; }
    LessonPage #right { width: 1fr; height: 1fr; layout: vertical; }
    LessonPage #work { display: none; }
    LessonPage #log { display: none; height: auto; }
    LessonPage #below, LessonPage #aside { display: none; width: 1fr; }
    LessonPage #told { height: 1fr; layout: horizontal; }
    LessonPage.-aside #aside { display: block; height: 1fr; }
    LessonPage.-panels #below { display: block; }
    LessonPage.-beside, LessonPage.-roomy { layout: horizontal; }
    LessonPage.-beside #left, LessonPage.-roomy #left { width: 1fr; height: 1fr; }
    LessonPage.-beside #stage, LessonPage.-roomy #stage { height: 1fr; padding: 0 1 0 0; }
    LessonPage.-roomy.-work #work { display: block; width: 1fr; height: 1fr; }
    LessonPage.-roomy.-work #log { display: block; }
    LessonPage #work, LessonPage #log { padding: 0 1 0 0; }
    LessonPage.-below #left { dock: bottom; }
    LessonPage.-below #work { display: block; height: 1fr; padding: 0 2; }
    LessonPage.-roomy.-still #stage { height: auto; }
    LessonPage.-roomy.-columns #left { layout: horizontal; }
    LessonPage.-roomy.-columns #stage { width: 1fr; }
    """

    def __init__(self, *scenes: LessonSceneView | PlaybackSceneView) -> None:
        super().__init__()
        self._scenes = scenes
        self._texts = {
            name: TextRows(id=name) for name in ("picture", "log", "work", "words", "ask", "below", "aside")
        }
        """Made at once: the screen may be given its size, and fill them, before they are mounted."""
        self._content = LessonContent(())
        self._top = 0
        self._offset = 0
        """Rows of the picture that stand above the words and scroll with them."""
        self._room = 1
        self._heights: dict[str, int | str] = {}

    def compose(self) -> ComposeResult:
        with Container(id="left"):
            with Container(id="stage"):
                yield from self._scenes
                yield self._texts["picture"]
                yield self._texts["log"]
            yield self._texts["work"]
        with Container(id="told"):
            with Container(id="right"):
                yield self._texts["words"]
                yield self._texts["ask"]
                yield self._texts["below"]
            yield self._texts["aside"]

    def show(self, content: LessonContent, room: int, layout: PageLayout) -> None:
        """``room``: rows there are for all of it."""
        is_roomy = layout is PageLayout.ROOMY
        has_work = bool(content.file_title) and is_roomy
        picture = [row("  " + line) for line in content.picture]
        self._offset = len(picture) if is_roomy else 0
        if is_roomy:  # a picture may be wider than what is left beside the words
            content, picture = replace(content, words=[*picture, *content.words], picture=()), []
        # A file that is short stands below the scene, whole; a long one beside it.
        short = len(content.file) + 2
        is_short = has_work and short + LEAST_PICTURE <= room
        if content.is_backdrop and not is_short:
            content = replace(content, moves=None)
        self._content = content
        has_picture = content.moves is not None or bool(picture)
        is_beside = layout is not PageLayout.STACKED and (has_picture or has_work)
        self.set_class(is_beside and not is_roomy, "-beside")
        self.set_class(is_beside and is_roomy, "-roomy")
        self.set_class(has_work, "-work")
        self.set_class(content.moves is None, "-still")
        self.query_one("#told").styles.width = content.words_width if is_beside else None
        # Where nothing moves the file has all columns beside the words.
        is_columns = self.size.width >= COLUMNS_WIDTH and content.moves is not None and not is_short
        self.set_class(is_columns, "-columns")
        self._set_height(self._rows("work"), short if is_short and content.moves is not None else "1fr")
        self._rows("picture").show_all(picture)
        self._rows("picture").display = bool(picture)
        for scene in self._scenes:
            scene.display = scene is content.moves
        self._rows("ask").show_all(content.asked)
        asked = len(content.asked)
        least = min(LEAST_PICTURE, max(room - asked - LEAST_WORDS, 4))
        rows = min(max(room - content.first_words - asked, least), content.moves_rows or MOST_PICTURE)
        if content.moves is not None:
            self._set_height(content.moves, "1fr" if is_beside else rows)
        used = 0 if is_beside else rows if content.moves is not None else len(picture)
        self._room = max(1, room - used - asked)
        below = self._room - max(content.most_words, len(content.words)) - 1
        is_below = bool(content.file_title) and not is_beside and not used and below >= LEAST_FILE
        self.set_class(is_below, "-below")
        self._set_height(self.query_one("#left"), below if is_below else "1fr" if is_beside else "auto")
        has_work = has_work or is_below
        kept = max(content.most_words, len(content.words))
        self._set_height(self._rows("words"), min(kept, self._room) if content.asked else "1fr")
        self._show_words()
        self._show_aside(0 if is_beside or is_below else room - used)
        if is_short and content.moves is not None:  # the file has no row more than it needs
            panels = (*content.panels[:1], *content.aids, *content.panels[1:])
            content = self._content = replace(content, panels=panels, aids=())
        self._show_below(self._room - kept if is_beside and is_roomy else 0)
        if has_work:
            # then it has the height that it will have
            self.call_after_refresh(self._show_work, content, has_title=not is_below)

    def _show_aside(self, room: int) -> None:
        """Panels beside the words and what is asked, where nothing else is. ``room``: rows that both have."""
        content = self._content
        told = [row_width(each) for each in (*content.words, *content.asked)]
        column = MARGIN + max(min(content.words_width - MARGIN, TEXT_WIDTH + MARGIN), *told)
        columns = min(content.page_width - column - MARGIN, TEXT_WIDTH)
        rows = panel_rows(content.panels, columns, room) if columns >= LEAST_ASIDE else []
        self.set_class(bool(rows), "-aside")
        self.query_one("#right").styles.width = column if rows else None
        self._rows("aside").show(rows)

    def _show_below(self, room: int) -> None:
        """Panels below the words and what is asked, at the bottom of the page. ``room``: rows that are kept free of words."""
        content = self._content
        rows = panel_rows(content.panels, content.words_width - 2 * MARGIN, room - 1, upwards=True)
        self.set_class(bool(rows), "-panels")
        if rows:
            blank = [row()] * (room - len(rows) if content.asked else 0)
            self._rows("below").show_all([*blank, *(row(" " * MARGIN, *each) for each in rows)])

    def _show_work(self, content: LessonContent, *, has_title: bool) -> None:
        """The student's file, around the line to look at, and the end of what the program printed. Its title is left out where
        the row below it has its name."""
        log = content.log[-MOST_LOG + 1 :]
        self._rows("log").show_all([row(("What it printed", "bold")), *log] if log else [])
        work = self._rows("work")
        room = max(1, work.size.height - has_title)
        above = room // 3 if room > 2 * LEAST_FILE else 0
        top = max(0, min(content.file_line - above, len(content.file) - room))
        more = lines_shown(top, min(room, len(content.file)), len(content.file))
        head = [row((content.file_title, "title"), (f"  {more}", "dim"))] if has_title else []
        shown = [*head, *(fitted(each, work.size.width) for each in content.file[top : top + room])]
        columns = min(work.size.width - MARGIN, TEXT_WIDTH)
        left = work.size.height - len(shown) - 1
        work.show([*shown, *(panel_rows(content.aids, columns, left) if columns >= LEAST_ASIDE else [])])

    def scroll_words(self, lines: int) -> None:
        """Scrolls by lines, at most by a page so that none is skipped; by more than there are, to the end."""
        page = max(1, self._room - 1)  # the last row may say that more follows
        self._top += lines if abs(lines) > len(self._content.words) else max(-page, min(lines, page))
        self._show_words()

    def scroll_words_to(self, line: int) -> None:
        """Scrolls so that a line and as much as possible of what follows is in sight."""
        self._top = line + self._offset if line else 0
        self._show_words()

    def scroll_words_into_sight(self, line: int) -> None:
        """Scrolls as little as needed to show a line and a few below it; the last row may say that more follows."""
        most, top = max(0, self._room - LINES_SEEN - 1), self._top - self._offset
        if not top <= line <= top + most:
            self.scroll_words_to(max(0, line - most) if line > top else line)

    def _set_height(self, widget: Widget, height: int | str) -> None:
        """Sets the height in rows, or as a share of the rest. Setting it again costs nothing."""
        assert widget.id is not None
        if self._heights.get(widget.id) != height:
            self._heights[widget.id] = widget.styles.height = height

    def _show_words(self) -> None:
        words = self._content.words
        self._top = max(0, min(self._top, len(words) - self._room))
        shown = list(words[self._top : self._top + self._room])
        below = len(words) - self._top - len(shown)
        if below > 0 and shown:
            shown[-1] = row((f"  ... {below + 1} more lines: {self._content.scrolls_with}", "dim"))
        self._rows("words").show(shown)

    def _rows(self, name: str) -> TextRows:
        return self._texts[name]
