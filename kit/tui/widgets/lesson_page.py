"""The middle of a lesson's screen: the picture first, the words below or beside it, what is asked always in sight."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from textual.app import ComposeResult
from textual.containers import Container
from textual.widget import Widget

from kit.tui.widgets.learning_scene_view import LearningSceneView
from kit.tui.widgets.lesson_scene_view import LessonSceneView
from kit.tui.widgets.text_rows import Row, TextRows, row

LEAST_PICTURE: Final = 8
MOST_PICTURE: Final = 14
"""Rows of a scene above the words."""
LEAST_WORDS: Final = 3
"""Rows of the words below it, on the smallest screen."""
LINES_SEEN: Final = 2
"""Rows of a verdict or a hint that are brought into sight."""
BESIDE: Final = 82
"""Columns of the words, where the picture is beside them."""


@dataclass(frozen=True, slots=True)
class LessonContent:
    """What stands on the sheet."""

    words: Sequence[Row]
    asked: Sequence[Row] = ()
    """Below the words, always in sight."""
    picture: Sequence[str] = ()
    """Fixed characters, in place of a scene."""
    moves: LessonSceneView | LearningSceneView | None = None
    """The scene that is seen, if any."""
    first_words: int = 0
    """Rows of words that the picture leaves room for, as far as it can."""
    most_words: int = 0
    """Rows of words there may be in this step: so many are kept free above what is asked, so that it never moves."""
    scrolls_with: str = "down"
    """The key that shows more words."""


class LessonPage(Container):
    """``scenes``: are opened and shut by whoever owns the sheet; one of them is seen at a time."""

    DEFAULT_CSS = f"""
    LessonPage {{ height: 1fr; layout: vertical; }}
    LessonPage #picture {{ height: auto; }}
    LessonPage #words {{ height: 1fr; }}
    LessonPage #ask {{ height: auto; }}
    LessonPage #right {{ height: 1fr; layout: vertical; }}
    LessonPage.-beside {{ layout: horizontal; }}
    LessonPage.-beside #picture {{ width: 1fr; }}
    LessonPage.-beside #right {{ width: {BESIDE}; }}
    """

    def __init__(self, *scenes: LessonSceneView | LearningSceneView) -> None:
        super().__init__()
        self._scenes = scenes
        self._content = LessonContent(())
        self._top = 0
        self._room = 1
        self._heights: dict[str, int | str] = {}

    def compose(self) -> ComposeResult:
        yield from self._scenes
        yield TextRows(id="picture")
        with Container(id="right"):
            yield TextRows(id="words")
            yield TextRows(id="ask")

    def show(self, content: LessonContent, room: int, *, beside: bool) -> None:
        """``room``: rows there are for all of it. ``beside``: the picture is, not above."""
        self._content = content
        self.set_class(beside and (content.moves is not None or bool(content.picture)), "-beside")
        picture = self._rows("picture")
        picture.show_all([row("  " + line) for line in content.picture])
        picture.display = bool(content.picture)
        for scene in self._scenes:
            scene.display = scene is content.moves
        self._rows("ask").show_all(content.asked)
        asked = len(content.asked)
        least = min(LEAST_PICTURE, max(room - asked - LEAST_WORDS, 4))
        rows = min(max(room - content.first_words - asked, least), MOST_PICTURE)
        if content.moves is not None:
            self._set_height(content.moves, "1fr" if beside else rows)
        used = 0 if beside else rows if content.moves is not None else len(content.picture)
        self._room = max(1, room - used - asked)
        kept = max(content.most_words, len(content.words))
        self._set_height(self._rows("words"), min(kept, self._room) if content.asked else "1fr")
        self._show_words()

    def scroll_words(self, lines: int) -> None:
        self._top += lines
        self._show_words()

    def scroll_words_to(self, line: int) -> None:
        """So that a line and what follows is in sight, if not all is."""
        self._top = line
        self._show_words()

    def scroll_words_into_sight(self, line: int) -> None:
        """As little as is needed so that a line and a few below it can be seen; the last row may say that more follows."""
        most = max(0, self._room - LINES_SEEN - 1)
        if not self._top <= line <= self._top + most:
            self.scroll_words_to(max(0, line - most) if line > self._top else line)

    def _set_height(self, widget: Widget, height: int | str) -> None:
        """In rows, or as a share of what is left. The same once more costs nothing."""
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
        return self.query_one(f"#{name}", TextRows)
