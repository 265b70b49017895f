"""Decides once what to show in this terminal, before Textual is imported; each decision has its reason.

Textual itself does not refuse a dumb terminal, sends braille to the Linux console, and takes NO_COLOR out of
the environment; so the questions are asked here. Pure but for ``TerminalFacts.here``.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Final, Generic, Literal, TextIO, TypeVar

Glyphs = Literal["braille", "block", "ascii"]
Colour = Literal["none", "ansi16", "256", "truecolour"]
Room = Literal["full", "compact", "too small"]
ThemeName = Literal["terminal", "dark", "light", "contrast", "colorblind"]
Between = Literal["tmux", "screen", "mosh"]
T = TypeVar("T")

FULL_SIZE: Final = (80, 24)
LEAST_SIZE: Final = (60, 18)
"""Columns and rows. Below FULL_SIZE panels are left out, below LEAST_SIZE there is one message."""

_COLOUR_OPTIONS: Final[Mapping[str, Colour]] = MappingProxyType(
    {"none": "none", "16": "ansi16", "256": "256", "true": "truecolour"}
)
COLOUR_CHOICES: Final = tuple(_COLOUR_OPTIONS)
"""The values of ``--color``."""
GLYPH_CHOICES: Final[tuple[Glyphs, ...]] = ("braille", "block", "ascii")
"""The values of ``--glyphs``."""

THEME_CHOICES: Final[tuple[ThemeName, ...]] = ("terminal", "dark", "light", "contrast", "colorblind")
"""The values of ``--theme``."""
THEME_VARIABLE: Final = "KIT_THEME"
COLOUR_VARIABLE: Final = "KIT_COLOR"
"""Environment variables that say the same as ``--theme`` and ``--color``."""
MOUSE_VARIABLE: Final = "KIT_MOUSE"
"""If set to 1, the kit gets clicks and the wheel; otherwise the terminal keeps the mouse."""

_TRUE_COLOUR_TERMS: Final = ("xterm-kitty", "xterm-ghostty", "alacritty", "foot", "wezterm", "contour")
"""How the names of terminals begin that have true colours; others say so in COLORTERM or end in -direct."""
_NO_SCREEN: Final = frozenset({"", "dumb", "unknown"})
_ASCII_ONLY: Final = ("linux", "vt1", "vt2", "vt3", "vt4", "vt5", "ansi")
"""How the names of terminals begin that have no braille and no blocks."""
_COLOURLESS: Final = ("vt1", "vt2", "vt3", "vt4", "vt5")
_SAMPLE: Final = "⣿█─"


@dataclass(frozen=True, slots=True)
class TerminalFacts:
    """What the process was given."""

    stdin_tty: bool = True
    stdout_tty: bool = True
    stderr_tty: bool = True
    encoding: str = "utf-8"
    """Encoding of standard error, where Textual draws."""
    size: tuple[int, int] = FULL_SIZE
    """Columns and rows."""

    @classmethod
    def here(cls) -> TerminalFacts:
        """Returns the facts of this process."""
        try:
            size = tuple(os.get_terminal_size(sys.__stderr__.fileno())) if sys.__stderr__ else (0, 0)
        except (OSError, ValueError):
            size = (0, 0)
        columns, rows = size
        return cls(
            stdin_tty=_is_tty(sys.__stdin__),
            stdout_tty=_is_tty(sys.__stdout__),
            stderr_tty=_is_tty(sys.__stderr__),
            encoding=(sys.__stderr__.encoding if sys.__stderr__ else None) or "ascii",
            size=(columns or FULL_SIZE[0], rows or FULL_SIZE[1]),
        )


def _is_tty(stream: TextIO | None) -> bool:
    try:
        return stream is not None and stream.isatty()
    except ValueError:  # closed
        return False


@dataclass(frozen=True, slots=True)
class TerminalOptions:
    """What the user asked for: ``--plain``, ``--glyphs``, ``--color``."""

    plain: bool = False
    glyphs: Glyphs | None = None
    color: str | None = None
    """One of COLOUR_CHOICES."""


@dataclass(frozen=True, slots=True)
class ReasonedValue(Generic[T]):
    """A value and, in a sentence, why."""

    value: T
    reason: str


@dataclass(frozen=True, slots=True)
class TerminalDecision:
    """All that is decided about the terminal."""

    plain: ReasonedValue[bool]
    """Text line by line instead of a full screen."""
    glyphs: ReasonedValue[Glyphs]
    """What the world is drawn with; with ``ascii``, borders are ASCII too."""
    colour: ReasonedValue[Colour]
    theme_name: ReasonedValue[ThemeName]
    """``terminal`` where the terminal's own colours are used, or none."""
    remote: ReasonedValue[bool]
    between: ReasonedValue[Between | None]
    """The program between us and the terminal."""
    ask_keyboard: ReasonedValue[bool]
    """Whether to ask the terminal for key releases."""
    room: ReasonedValue[Room]
    reduce_motion: ReasonedValue[bool] = field(default=ReasonedValue(False, "KIT_REDUCE_MOTION is not set."))
    """Whether pictures that move by themselves show their beginning and their end alone."""
    mouse: ReasonedValue[bool] = field(default=ReasonedValue(False, "KIT_MOUSE is not set."))
    """Whether clicks and the wheel are the kit's, not the terminal's."""
    size: tuple[int, int] = field(default=FULL_SIZE)

    @property
    def ansi(self) -> bool:
        """Whether to draw in the terminal's own 16 colours, or in none: ``App(ansi_color=...)``."""
        return self.colour.value in ("none", "ansi16")

    @property
    def theme(self) -> str:
        """The Textual theme that goes with the colours."""
        return "ansi-dark" if self.ansi else f"kit-{self.theme_name.value}"

    def environment(self) -> dict[str, str]:
        """The environment variables that tell Textual; to be set before it is imported.

        NO_COLOR is among them where there shall be no colour: Textual takes it out again when the app is
        made, so whoever starts other programs later has to set it for them.
        """
        system = {"none": "standard", "ansi16": "standard", "256": "256", "truecolour": "truecolor"}
        settings = {"TEXTUAL_COLOR_SYSTEM": system[self.colour.value]}
        if self.colour.value == "none":
            settings["NO_COLOR"] = "1"
        if self.remote.value or self.reduce_motion.value:
            settings["TEXTUAL_ANIMATIONS"] = "none"
        return settings


def decide_terminal(
    environ: Mapping[str, str], facts: TerminalFacts, wishes: TerminalOptions | None = None
) -> TerminalDecision:
    """Decides from the environment, the standard streams and the command line. Reads nothing else."""
    wishes = wishes or TerminalOptions()
    term = environ.get("TERM", "")
    remote = _remote(environ)
    between = _terminal_between(environ, term)
    colour = _colour(environ, term, wishes)
    return TerminalDecision(
        plain=_plain(term, facts, wishes),
        glyphs=_glyphs(term, facts, wishes),
        colour=colour,
        theme_name=_theme_name(environ, colour.value),
        remote=remote,
        between=between,
        ask_keyboard=_ask_keyboard(environ, term),
        room=_screen_room(facts.size),
        reduce_motion=_reduce_motion(environ),
        mouse=_mouse(environ),
        size=facts.size,
    )


def _plain(term: str, facts: TerminalFacts, wishes: TerminalOptions) -> ReasonedValue[bool]:
    streams = (
        ("Standard input", facts.stdin_tty),
        ("Standard output", facts.stdout_tty),
        ("Standard error", facts.stderr_tty),
    )
    away = [name for name, tty in streams if not tty]
    if wishes.plain:
        return ReasonedValue(True, "--plain was given.")
    if away:
        return ReasonedValue(True, f"{away[0]} is not a terminal.")
    if term in _NO_SCREEN:
        named = f"TERM is {term!r}" if term else "TERM is not set"
        return ReasonedValue(True, f"{named}: this terminal cannot move its cursor.")
    return ReasonedValue(False, f"A terminal of type {term} on all three standard streams.")


def _can_encode(encoding: str, text: str) -> bool:
    try:
        text.encode(encoding)
    except (UnicodeEncodeError, LookupError):
        return False
    return True


def _glyphs(term: str, facts: TerminalFacts, wishes: TerminalOptions) -> ReasonedValue[Glyphs]:
    if not _can_encode(facts.encoding, _SAMPLE):
        return ReasonedValue("ascii", f"Standard error is encoded as {facts.encoding}, which has no braille.")
    if wishes.glyphs:
        return ReasonedValue(wishes.glyphs, f"--glyphs {wishes.glyphs} was given.")
    if term.startswith(_ASCII_ONLY):
        return ReasonedValue("ascii", f"A terminal of type {term} has no font for braille.")
    return ReasonedValue(
        "braille", f"Standard error is encoded as {facts.encoding}, and {term} should have the font."
    )


def _colour(environ: Mapping[str, str], term: str, wishes: TerminalOptions) -> ReasonedValue[Colour]:
    if wishes.color:
        return ReasonedValue(_COLOUR_OPTIONS[wishes.color], f"--color {wishes.color} was given.")
    if (asked := environ.get(COLOUR_VARIABLE, "")) in _COLOUR_OPTIONS:
        return ReasonedValue(_COLOUR_OPTIONS[asked], f"{COLOUR_VARIABLE} is {asked}.")
    if environ.get("NO_COLOR"):
        return ReasonedValue("none", "NO_COLOR is set.")
    if term.startswith(_COLOURLESS) or term.endswith(("-m", "-mono")):
        return ReasonedValue("none", f"A terminal of type {term} has no colours.")
    theme = environ.get(THEME_VARIABLE, "")
    if theme == "terminal":
        return ReasonedValue("ansi16", "The theme is the terminal's own 16 colours.")
    if environ.get("COLORTERM") in ("truecolor", "24bit"):
        return ReasonedValue("truecolour", f"COLORTERM is {environ['COLORTERM']}.")
    if term.startswith(_TRUE_COLOUR_TERMS) or term.endswith("-direct"):
        return ReasonedValue("truecolour", f"A terminal of type {term} has true colours.")
    if theme in THEME_CHOICES and "256color" in term:
        return ReasonedValue("256", f"The theme {theme} was chosen, and {term} has 256 colours.")
    return ReasonedValue(
        "ansi16",
        "Your terminal's own 16 colours: the fewest bytes, and readable on light and dark backgrounds.",
    )


def _theme_name(environ: Mapping[str, str], colour: Colour) -> ReasonedValue[ThemeName]:
    """Of 16 colours only whether they stand on a light background: they are the terminal's own."""
    own: ReasonedValue[ThemeName] = ReasonedValue("terminal", "Themes need 256 colours.")
    if colour == "none":
        return own
    asked = environ.get(THEME_VARIABLE, "")
    for name in ("light",) if colour == "ansi16" else THEME_CHOICES[1:]:
        if name == asked:
            return ReasonedValue(name, f"{THEME_VARIABLE} or --theme is {name}.")
    # rxvt's variable, set by others too: the numbers of foreground and background among the 16 colours.
    background = environ.get("COLORFGBG", "").rpartition(";")[2]
    if background in ("7", "15"):
        return ReasonedValue("light", f"COLORFGBG is {environ['COLORFGBG']}: a light background.")
    return (
        own if colour == "ansi16" else ReasonedValue("dark", "No setting says that the background is light.")
    )


def _remote(environ: Mapping[str, str]) -> ReasonedValue[bool]:
    for name in ("SSH_CONNECTION", "SSH_TTY", "SSH_CLIENT"):
        if environ.get(name):
            return ReasonedValue(True, f"{name} is set.")
    return ReasonedValue(False, "No SSH variable is set.")


def _reduce_motion(environ: Mapping[str, str]) -> ReasonedValue[bool]:
    value = environ.get("KIT_REDUCE_MOTION", "")
    if not value:
        return ReasonedValue(False, "KIT_REDUCE_MOTION is not set.")
    return ReasonedValue(value.lower() not in ("0", "no", "off", "false"), f"KIT_REDUCE_MOTION is {value}.")


def _mouse(environ: Mapping[str, str]) -> ReasonedValue[bool]:
    value = environ.get(MOUSE_VARIABLE, "")
    if value.lower() not in ("", "0", "no", "off", "false"):
        return ReasonedValue(
            True, f"{MOUSE_VARIABLE} is {value}; most terminals still select text with Shift."
        )
    return ReasonedValue(
        False, f"You can select and copy text. {MOUSE_VARIABLE}=1 gives clicks and the wheel to the kit."
    )


def _terminal_between(environ: Mapping[str, str], term: str) -> ReasonedValue[Between | None]:
    if environ.get("TMUX") or term.startswith("tmux"):
        return ReasonedValue("tmux", "TMUX is set." if environ.get("TMUX") else f"TERM is {term}.")
    if environ.get("STY") or term.startswith("screen"):
        return ReasonedValue("screen", "STY is set." if environ.get("STY") else f"TERM is {term}.")
    if environ.get("NCURSES_NO_UTF8_ACS") == "1" and _remote(environ).value:
        return ReasonedValue("mosh", "NCURSES_NO_UTF8_ACS is 1, as mosh sets it.")
    return ReasonedValue(None, "There is no sign of tmux, screen or mosh.")


def _ask_keyboard(environ: Mapping[str, str], term: str) -> ReasonedValue[bool]:
    if environ.get("TEXTUAL_DISABLE_KITTY_KEY") == "1":
        return ReasonedValue(False, "TEXTUAL_DISABLE_KITTY_KEY is 1.")
    if term.startswith(_ASCII_ONLY):
        return ReasonedValue(False, f"A terminal of type {term} would print the query.")
    return ReasonedValue(True, "A terminal that does not know the query ignores it.")


def _screen_room(size: tuple[int, int]) -> ReasonedValue[Room]:
    def holds(least: tuple[int, int]) -> bool:
        return size[0] >= least[0] and size[1] >= least[1]

    here = f"{size[0]}x{size[1]}"
    if holds(FULL_SIZE):
        return ReasonedValue("full", f"{here} fits the whole screen of {FULL_SIZE[0]}x{FULL_SIZE[1]}.")
    if holds(LEAST_SIZE):
        return ReasonedValue(
            "compact", f"{here} is less than {FULL_SIZE[0]}x{FULL_SIZE[1]}: panels are left out."
        )
    return ReasonedValue(
        "too small", f"{here} is less than {LEAST_SIZE[0]}x{LEAST_SIZE[1]}: make the window larger."
    )
