"""The middle of a lesson's screen: its scene first, the words below or beside it, what is asked always in sight."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum
from itertools import accumulate
from typing import Final

from textual.app import ComposeResult
from textual.containers import Container
from textual.widget import Widget

from kit.dialogue.dialogue import Panel
from kit.document.rows import MARGIN, TEXT_WIDTH, Row, at_both_edges, broken, lines_shown, row, row_width
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
"""Columns of the picture, before the words get more than they need."""

ROOMY_SIZE: Final = (120, 30)
"""Columns and rows from which on the scene and the file stand beside the words, all at once."""
LEAST_ASIDE: Final = 36
"""Columns of the panels beside the words, at least."""
LEAST_CODE, MOST_CODE, CODE_STEP = 56, 112, 4
"""Columns of a program's longest line: at least, at most, and the steps in which they grow, so that not each letter moves all."""
WORDS_BETWEEN: Final = (62, 78)
"""Columns of the words between the file and the panels: at least, and at most."""
LEAST_BEYOND: Final = 46
"""Columns of the panels beyond the file and the words, at least."""
MOST_MAP: Final = 20
"""Rows of a scene below the words."""
ROWS_FOR_VERDICT: Final = 12
"""Rows that are left free for a verdict, where what stands below has its least ones all the same."""


@dataclass(frozen=True, slots=True)
class FileColumns:
    """The columns of a page that shows a file beside its words, and panels beside both where there is room."""

    file: int
    words: int
    aside: int

    @classmethod
    def of(cls, columns: int, longest: int, least_words: int = LEAST_ASIDE) -> FileColumns:
        """The columns for a file whose longest line, with its number, has so many: it is whole before the words are wide.

        >>> FileColumns.of(120, 82), FileColumns.of(200, 82)
        (FileColumns(file=84, words=36, aside=0), FileColumns(file=85, words=69, aside=46))
        """
        needed = min(max(LEAST_CODE, -(-longest // CODE_STEP) * CODE_STEP), MOST_CODE) + 1
        left = columns - needed - LEAST_BEYOND
        if left >= max(WORDS_BETWEEN[0], least_words):
            words = min(left, max(WORDS_BETWEEN[1], least_words))
            return cls(needed, words, columns - needed - words)
        words = max(least_words, LEAST_ASIDE, min(columns - needed, words_beside(columns)))
        return cls(columns - words, words, 0)


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
    moves_rows: int = 0
    """Rows that the scene has a use for; 0: as many as there are."""
    first_words: int = 0
    """Rows of words that the picture leaves room for, as far as it can."""
    most_words: int = 0
    """Rows of words there may be in this step: that many are kept free above what is asked, so that it never moves."""
    scrolls_with: str = "down"
    """The key that shows more words."""
    step_rows: int = 0
    """Rows of the step's own words, without what is said to what the student did."""
    file: Sequence[Sequence[Row]] = ()
    """The student's file: the rows of each of its lines; shown where there is room."""
    file_columns: FileColumns | None = None
    """The columns of a roomy page that shows the file."""
    words_width: int = BESIDE[0]
    """Columns of the words, where something stands beside them."""
    file_title: str = ""
    file_line: int = 0
    """The line of it to look at first, counted from 0."""
    is_at_file: bool = False
    """Whether the file is what is read and scrolled: where it has no place beside the words it stands in theirs."""
    aids: Sequence[Panel] = ()
    """Below the file, as far as it leaves room; where a scene stands there, below the words."""
    panels: Sequence[Panel] = ()
    """What a roomy page has where the words leave room: below them, or beside them where nothing else is."""
    page_width: int = 0
    """Columns of the page."""


class LessonPage(Container):
    """``scenes``: are opened and shut by whoever owns the sheet; one of them is seen at a time."""

    DEFAULT_CSS = """
    LessonPage { height: 1fr; layout: vertical; layers: base scene; }
    LessonPage #stage { height: auto; layout: vertical; }
    LessonPage #picture { height: auto; }
    LessonPage #words { height: 1fr; }
    LessonPage #ask { height: auto; }
    LessonPage #right { width: 1fr; height: 1fr; layout: vertical; }
    LessonPage #work { display: none; }
    LessonPage #below, LessonPage #aside { display: none; width: 1fr; }
    LessonPage #told { height: 1fr; layout: horizontal; }
    LessonPage.-aside #aside { display: block; height: 1fr; }
    LessonPage.-panels #below { display: block; }
    LessonPage.-beside { layout: horizontal; }
    LessonPage.-beside #stage { width: 1fr; height: 1fr; padding: 0 1 0 0; }
    LessonPage.-work #stage { layer: scene; padding: 0; }
    LessonPage.-work #work { display: block; }
    LessonPage.-below #work { display: block; dock: bottom; }
    LessonPage.-file #work { display: block; height: 1fr; }
    LessonPage.-file #told, LessonPage.-file #stage { display: none; }
    """

    def __init__(self, *scenes: LessonSceneView | PlaybackSceneView) -> None:
        super().__init__()
        self._scenes = scenes
        self._texts = {
            name: TextRows(id=name) for name in ("picture", "work", "words", "ask", "below", "aside")
        }
        """Made at once: the screen may be given its size, and fill them, before they are mounted."""
        self._content = LessonContent(())
        self._top = 0
        self._offset = 0
        """Rows of the picture that stand above the words and scroll with them."""
        self._room = 1
        self._sizes: dict[str, tuple[int | str | None, ...]] = {}
        self._stage_offset = 0, 0
        self._file_top: int | None = None
        """The first row of the file in sight, once it was scrolled; None: the one that shows the line to look at."""
        self._file_shown: object = None
        """The line of the file that is to be looked at, for which it was scrolled."""
        self._file_room = 1
        self._file_place: tuple[int, int, Sequence[Panel]] = (1, 1, ())
        """Columns and rows of the file, and what stands below it."""
        self.is_file_cut = False
        """Whether not all of the file is in sight."""

    def compose(self) -> ComposeResult:
        with Container(id="stage"):
            yield from self._scenes
            yield self._texts["picture"]
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
        picture = [row("  " + line) for line in content.picture]
        self._offset = len(picture) if is_roomy else 0
        if is_roomy:  # a picture may be wider than what is left beside the words
            content, picture = replace(content, words=[*picture, *content.words], picture=()), []
        self._content = content
        shown = content.file_title, content.file_line
        if shown != self._file_shown:
            self._file_shown, self._file_top = shown, None
        columns = content.file_columns if is_roomy and content.file_title else None
        has_picture = content.moves is not None or bool(picture)
        is_beside = columns is not None or (layout is not PageLayout.STACKED and has_picture)
        is_file = columns is None and content.is_at_file and bool(content.file)
        self.set_class(is_beside, "-beside")
        self.set_class(columns is not None, "-work")
        self.set_class(is_file, "-file")
        self._rows("picture").show_all(picture)
        self._rows("picture").display = bool(picture)
        self.query_one("#stage").display = has_picture
        for scene in self._scenes:
            scene.display = scene is content.moves
        self._rows("ask").show_all(content.asked)
        if columns is not None:
            self._show_beside_file(content, columns, room)
            return
        asked = len(content.asked)
        least = min(LEAST_PICTURE, max(room - asked - LEAST_WORDS, 4))
        rows = min(max(room - content.first_words - asked, least), content.moves_rows or MOST_PICTURE)
        if content.moves is not None:
            self._set_size(content.moves, height="1fr" if is_beside else rows)
        used = 0 if is_beside else rows if content.moves is not None else len(picture)
        self._room = max(1, room - used - asked)
        below = self._room - max(content.most_words, len(content.words)) - 1
        is_below = bool(content.file) and not is_beside and not used and below >= LEAST_FILE and not is_file
        self.set_class(is_below, "-below")
        self._place_stage("1fr", "1fr" if is_beside else "auto")
        self._set_size(self.query_one("#told"), content.words_width if is_beside else None, "1fr")
        kept = max(content.most_words, len(content.words))
        self._set_size(self._rows("words"), height=min(kept, self._room) if content.asked else "1fr")
        self._show_words()
        self._show_aside(0 if is_beside or is_below or is_file else room - used)
        self._show_below(self._room - kept if is_beside and is_roomy else 0)
        self._set_size(self._rows("work"), None, below if is_below else "1fr")
        self.is_file_cut = bool(content.file) and not is_below
        if is_below or is_file:
            self._show_file(content.page_width, below if is_below else room)

    def _show_beside_file(self, content: LessonContent, columns: FileColumns, room: int) -> None:
        """The file in its whole width, the words beside it, and the scene below the one that leaves room for it."""
        left = room - 1 - sum(len(self._file_rows(line[:1], columns.file)) for line in content.file)
        below_words = room - content.step_rows - self._offset - 1
        rows, x = 0, 0
        if content.moves is not None:
            rows = max(LEAST_PICTURE, left - 1)
            if left <= LEAST_PICTURE <= below_words:
                rows, x = max(LEAST_PICTURE, min(below_words - ROWS_FOR_VERDICT, MOST_MAP)), columns.file
            self._set_size(content.moves, height="1fr")
            self._place_stage((columns.words if x else columns.file) - MARGIN, rows, (x, room - rows))
        code = room if x or not rows else room - rows - 1
        self._set_size(self._rows("work"), columns.file, code)
        self._set_size(self.query_one("#told"), columns.words + columns.aside, "1fr")
        self._set_size(self.query_one("#right"), columns.words, room - rows - 1 if x else "1fr")
        self._room = max(1, (room - rows - 1 if x else room) - len(content.asked))
        self._show_words()
        # Where they are whole, or else where they are less cut.
        has_aids_here = not rows and (
            len(panel_rows(content.aids, min(columns.file - MARGIN, TEXT_WIDTH), room)) < left
            or below_words < left > LEAST_FILE
        )
        aids = () if has_aids_here else content.aids
        panels = () if columns.aside else content.panels
        self._content = replace(content, panels=(*panels[:1], *aids, *panels[1:]))
        # A verdict has its place between the words and the panels, which do not move then; where that would cut them they stand at
        # the bottom, as far as the verdict leaves room.
        kept = max(content.most_words, len(content.words))
        reserved = max(kept, content.step_rows + self._offset + ROWS_FOR_VERDICT)
        below = self._panel_rows(room)
        is_cut = len(below) >= self._room - reserved
        used = kept if is_cut else reserved
        height = min(used, self._room) if content.asked or not is_cut else "1fr"
        self._set_size(self._rows("words"), height=height)
        self._show_below(self._room - used, None if is_cut else below)
        beside = panel_rows(content.panels, columns.aside - MARGIN, room) if columns.aside else []
        self.set_class(bool(beside), "-aside")
        self._rows("aside").show(beside)
        self._show_file(columns.file, code, content.aids if has_aids_here else ())

    def _show_aside(self, room: int) -> None:
        """Panels beside the words and what is asked, where nothing else is. ``room``: rows that both have."""
        content = self._content
        told = [row_width(each) for each in (*content.words, *content.asked)]
        column = MARGIN + max(min(content.words_width - MARGIN, TEXT_WIDTH + MARGIN), *told)
        columns = min(content.page_width - column - MARGIN, TEXT_WIDTH)
        rows = panel_rows(content.panels, columns, room) if columns >= LEAST_ASIDE else []
        self.set_class(bool(rows), "-aside")
        self._set_size(self.query_one("#right"), column if rows else "1fr", "1fr")
        self._rows("aside").show(rows)

    def _show_below(self, room: int, rows: Sequence[Row] | None = None) -> None:
        """Panels below the words and what is asked, at the bottom of the page. ``room``: rows that are kept free of words.
        ``rows``: those of the panels, if they are known."""
        content = self._content
        rows = self._panel_rows(room) if rows is None else rows
        self.set_class(bool(rows), "-panels")
        if rows:
            blank = [row()] * (room - len(rows) if content.asked else 0)
            self._rows("below").show_all([*blank, *(row(" " * MARGIN, *each) for each in rows)])

    def _panel_rows(self, room: int) -> list[Row]:
        """The panels below the words. ``room``: rows, with an empty one above them."""
        return panel_rows(
            self._content.panels, self._content.words_width - 2 * MARGIN, room - 1, upwards=True
        )

    @staticmethod
    def _file_rows(line: Sequence[Row], columns: int) -> list[Row]:
        """A line of the file, on as many rows as it needs."""
        return [part for each in line for part in broken(each, columns - 1)]

    def _show_file(self, columns: int, rows: int, aids: Sequence[Panel] = ()) -> None:
        """The student's file, around the line to look at, and below it what has room there. Beside the words it has a title; else
        its last row says whether there is more."""
        self._file_place = columns, rows, aids
        content, has_title = self._content, self.has_class("-work")
        lines = [self._file_rows(line, columns) for line in content.file]
        starts = list(accumulate(map(len, lines), initial=0))
        whole = [each for line in lines for each in line]
        self.is_file_cut = len(whole) > rows - has_title
        # The row that says which lines are shown.
        room = self._file_room = max(1, rows - (has_title or self.is_file_cut))
        if self._file_top is None:
            above = room // 5 if room > 2 * LEAST_FILE else 0
            self._file_top = starts[min(content.file_line, len(lines))] - above
        top = self._file_top = max(0, min(self._file_top, len(whole) - room))
        shown = whole[top : top + room]
        last = top + len(shown)
        keys = f"{'' if content.is_at_file else 'Tab '}↑↓" if self.is_file_cut else ""
        first, end = bisect_right(starts, top) - 1, bisect_left(starts, last)
        more = lines_shown(first, end - first, len(lines)) if self.is_file_cut else ""
        if has_title:
            title = row((content.file_title, "title"), (f"  {more}", "dim"))
            shown = [at_both_edges(title, row((keys, "dim")), columns - 1), *shown]
        elif more:
            shown = [*shown, row((f"  {more}: {keys}", "dim"))]
        wide = min(columns - MARGIN, TEXT_WIDTH)
        self._rows("work").show([*shown, *panel_rows(aids, wide, rows - len(shown) - 1)])

    def _scroll_keys(self, *, is_here: bool) -> str:
        """The keys that show more of what is scrolled now, or first have the other be that."""
        return self._content.scrolls_with if is_here else f"Tab, {self._content.scrolls_with}"

    def scroll(self, lines: int) -> None:
        """Scrolls what is read, the words or the file."""
        if not self._content.is_at_file:
            self.scroll_words(lines)
            return
        page = max(1, self._file_room - 1)
        by = lines if abs(lines) > len(self._content.file) else max(-page, min(lines, page))
        self._file_top = (self._file_top or 0) + by
        self._show_file(*self._file_place)

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

    def _set_size(
        self, widget: Widget, width: int | str | None = None, height: int | str | None = None
    ) -> None:
        """Sets the size in cells, or as a share of the rest. Setting it again costs nothing."""
        assert widget.id is not None
        if self._sizes.get(widget.id) != (width, height):
            self._sizes[widget.id] = width, height
            widget.styles.width, widget.styles.height = width, height

    def _place_stage(self, width: int | str, height: int | str, offset: tuple[int, int] = (0, 0)) -> None:
        """Gives the scene its size, and its place where it stands on its own beside or below other parts."""
        stage = self.query_one("#stage")
        self._set_size(stage, width, height)
        if self._stage_offset != offset:
            self._stage_offset = stage.styles.offset = offset

    def _show_words(self) -> None:
        words = self._content.words
        self._top = max(0, min(self._top, len(words) - self._room))
        shown = list(words[self._top : self._top + self._room])
        below = len(words) - self._top - len(shown)
        if below > 0 and shown:
            shown[-1] = row(
                (
                    f"  ... {below + 1} more lines: {self._scroll_keys(is_here=not self._content.is_at_file)}",
                    "dim",
                )
            )
        self._rows("words").show(shown)

    def _rows(self, name: str) -> TextRows:
        return self._texts[name]
