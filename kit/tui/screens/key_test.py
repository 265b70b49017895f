"""The key test: press keys and see what arrives, what the kit makes of it, and in which mode."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import ClassVar, Final

from textual import events
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Container

from kit.dialogue.actions import ScreenActions
from kit.dialogue.screen_action import letter
from kit.document.blocks import Tone, ToneText, labelled_table
from kit.document.layout import Page, rows_of
from kit.document.rows import MARGIN, Row, at_both_edges, fitted, row, side_by_side
from kit.tui.input.drive import MODE_TEXTS, DriveState
from kit.tui.input.drive_keys import DRIVE_KEYS, DriveKey
from kit.tui.input.modes import Clock, KeyEventKind
from kit.tui.input.screen import DriveScreen
from kit.tui.rows.key_rows import bindings, footer
from kit.tui.rows.ruled_title import ruled_title
from kit.tui.terminal import TerminalDecision
from kit.tui.widgets.text_rows import RowsScreen, TextRows

BESIDE: Final = (110, 30)
"""Columns and rows of a terminal in which what arrived stands beside the keys, which have a column to themselves."""
KEYS_WIDTH: Final = 60
"""Columns of the keys there; on a very wide terminal they take more."""
NAME: Final = 13
"""Columns of a key's name with the blanks around it, and of its message with one before it."""
MODE_ROWS: Final = 2
LEAST_LOG: Final = 5
"""Rows of what arrived, with its title and the empty one before it."""
ROOMY_LOG: Final = 12
"""Rows of it that are kept free where more is told of the terminal."""
KEPT: Final = 50
"""Lines of what arrived: more than any screen shows."""
WORDS: Final = MappingProxyType(
    {
        KeyEventKind.PRESS: ("press", Tone.GOOD),
        KeyEventKind.REPEAT: ("repeat", Tone.DIM),
        KeyEventKind.RELEASE: ("release", Tone.BOLD),
        None: ("timeout", Tone.WARN),
    }
)
"""What came, in a word and its style."""
MEANINGS: Final = (
    ("press", "a key went down: its bar is full, and the robot drives"),
    ("repeat", "it is held; how fast they come depends on your keyboard's settings"),
    ("release", "it went up: only some terminals tell, and then driving is exact"),
    ("timeout", "nothing came for so long that the kit takes the key as up"),
)
"""What is said beside what arrived, where there is room, and before anything has."""


@dataclass(frozen=True, slots=True)
class KeyLogEntry:
    """One line of the log: what came, how long [s] after the one before, and the messages it caused."""

    kind: KeyEventKind | None
    key: str
    gap: float | None
    messages: tuple[str, ...]

    def row(self) -> Row:
        gap = f"+{1000 * self.gap:.0f} ms" if self.gap is not None and self.gap < 10 else ""
        word, style = WORDS[self.kind]
        return row(
            (f"{gap:>8}  ", "dim"),
            (f"{word:<8} ", style),
            f"{self.key:<18} ",
            (" ".join(self.messages), "dim"),
        )


class KeyTestScreen(RowsScreen[None], DriveScreen):
    """Shows what a key press becomes on this terminal. Drawn only when something comes."""

    DEFAULT_CSS = f"""
    KeyTestScreen {{ layout: vertical; }}
    KeyTestScreen #heading, KeyTestScreen #footer {{ height: 1; }}
    KeyTestScreen #mode {{ height: {MODE_ROWS}; }}
    KeyTestScreen #parts {{ height: 1fr; }}
    KeyTestScreen #keys {{ height: auto; }}
    KeyTestScreen #log {{ height: 1fr; }}
    KeyTestScreen.-beside #parts {{ layout: horizontal; }}
    KeyTestScreen.-beside #keys {{ width: 3fr; height: 1fr; min-width: {KEYS_WIDTH}; }}
    KeyTestScreen.-beside #log {{ width: 4fr; }}
    """
    screen_actions = ScreenActions(
        "key test",
        ("drive_mode", "close_key_test", "quit"),
        own=(
            letter("close_key_test", "x", "close", "close the key test"),
        ),
        drives=True,
    )  # fmt: skip
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)

    def __init__(self, terminal: TerminalDecision | None = None, clock: Clock = time.monotonic) -> None:
        super().__init__(terminal, clock)
        self._log: deque[KeyLogEntry] = deque(maxlen=KEPT)
        self._last: float | None = None

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        yield TextRows(id="mode")
        with Container(id="parts"):
            yield TextRows(id="keys")
            yield TextRows(id="log")
        yield TextRows(id="footer")

    def on_resize(self, event: events.Resize) -> None:
        self.set_class(self._is_beside, "-beside")
        self.call_after_refresh(self._show)

    def action_close_key_test(self) -> None:
        self.dismiss()

    def key_received(self, kind: KeyEventKind | None, key: str, messages: tuple[str, ...]) -> None:
        now = self._clock()
        gap = None if self._last is None else now - self._last
        self._log.appendleft(KeyLogEntry(kind, key, gap, messages))
        self._last = now
        self._show()

    def drive_keys_changed(self, messages: tuple[str, ...], state: DriveState) -> None:
        self._show()

    def drive_status_changed(self) -> None:
        self._show()

    # What is shown

    @property
    def _is_beside(self) -> bool:
        return self.size.width >= BESIDE[0] and self.size.height >= BESIDE[1]

    def _show(self) -> None:
        if not self.query(TextRows):  # while the kit is left
            return
        width = self.size.width
        title = row(("Key test", "title"), ("  press and hold keys", "dim"))
        self._rows("heading").show([at_both_edges(title, row((self.drive.choice.mode, "bold")), width)])
        self._rows("mode").show([fitted(each, width) for each in self._mode_rows()])
        if self._is_beside:
            self._rows("keys").show(self._key_column())
        else:
            self._rows("keys").show_all(self._key_pairs(width))
        self._rows("log").show(self._log_rows())
        self._rows("footer").show([footer(self.screen_actions, width)])

    def _mode_rows(self) -> list[Row]:
        """How keys drive on this terminal, and when one counts as up."""
        told = [row(f" {self.drive.status}")]
        if self.drive.timeouts is not None:
            first, later = (round(1000 * seconds) for seconds in self.drive.timeouts)
            silence = f" up when silent for {first} ms after a press, {later} ms after a repeat"
            told.append(row((silence, "dim")))
        return told

    def _key_column(self) -> list[Row]:
        """One key below the other, over the height that there is."""
        size = self._rows("keys").size
        blank = [row()] * max(0, (size.height - 2) // len(DRIVE_KEYS) - 1)
        keys = [each for key in DRIVE_KEYS for each in (self._key_row(key, size.width - MARGIN), *blank)]
        return [ruled_title("keys that drive", size.width - MARGIN), row(), *keys]

    def _key_pairs(self, width: int) -> list[Row]:
        """The keys in two columns."""
        half, count = width // 2, (len(DRIVE_KEYS) + 1) // 2
        left, right = (
            [self._key_row(key, half - MARGIN) for key in keys]
            for keys in (DRIVE_KEYS[:count], DRIVE_KEYS[count:])
        )
        return [ruled_title("keys that drive", width), *side_by_side(left, right, half)]

    def _key_row(self, key: DriveKey, width: int) -> Row:
        """A key, a bar for how strongly it pushes, and its message; a key that is down stands out."""
        strength = self.drive.state.held.get(key.name, 0.0)
        room = width - 2 * NAME
        bar = max(round(room * strength), 1 if strength else 0)
        style = "good" if strength else ""
        return row(
            (f" {key.label:<{NAME - 1}}", style),
            ("█" * bar, style),
            ("─" * (room - bar), "dim"),
            (f" {key.pressed:<{NAME - 1}}", style or "dim"),
        )

    def _log_rows(self) -> list[Row]:
        """What may arrive, and what has, the newest first; the one gives way to the other where there is no room for both."""
        width, height = self._rows("log").size
        told = [
            (ToneText(word, WORDS[kind][1]), text) for (word, text), kind in zip(MEANINGS, WORDS, strict=True)
        ]
        meant = _part("what may arrive", told, width)
        arrived = [ruled_title("what arrived", width, "newest first"), *(each.row() for each in self._log)]
        if len(meant) + LEAST_LOG > height:
            return arrived if self._log else meant
        for title, told in (("how keys drive", self._modes()), ("on the way here", self._facts())):
            more = [row(), *_part(title, told, width)]
            meant += more if told and len(meant) + len(more) + ROOMY_LOG <= height else []
        return [*meant, row(), *arrived]

    def _modes(self) -> list[tuple[ToneText, str]]:
        """All modes; the one that is used now is marked."""
        chosen = self.drive.choice.mode
        return [
            (ToneText(f"> {mode}", Tone.BOLD) if mode == chosen else ToneText(f"  {mode}", Tone.DIM), text)
            for mode, text in MODE_TEXTS.items()
        ]

    def _facts(self) -> list[tuple[ToneText, str]]:
        """What lies between the keyboard and the kit, as far as it is known."""
        terminal = self._terminal
        if terminal is None:
            return []
        found = (("link", terminal.remote.reason), ("between", terminal.between.reason))
        return [(ToneText(name, Tone.DIM), reason) for name, reason in found]


def _part(title: str, told: Sequence[tuple[ToneText, str]], width: int) -> list[Row]:
    """Words and what they mean, below their title."""
    return [ruled_title(title, width), *rows_of([labelled_table(told)], Page(width - 1, margin=1))]
