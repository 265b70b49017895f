"""The decision about the terminal, as a table; and that Textual does what the decision says."""

from __future__ import annotations

import os
import pty
import re
import select
import subprocess
import sys
import termios
from dataclasses import fields

import pytest

from kit.tui.terminal import (
    COLOUR_CHOICES,
    GLYPH_CHOICES,
    ReasonedValue,
    TerminalDecision,
    TerminalFacts,
    TerminalOptions,
    decide_terminal,
)
from tests.cases import every_case

XTERM = {"TERM": "xterm-256color"}
SSH = {"SSH_CONNECTION": "10.0.0.1 5 10.0.0.2 22"}
NOTHING = TerminalFacts()


def verdict(
    environ: dict[str, str], facts: TerminalFacts = NOTHING, wishes: TerminalOptions | None = None
) -> TerminalDecision:
    return decide_terminal(environ, facts, wishes)


@every_case(
    ("environ", "facts", "wishes", "plain", "why"),
    [
        (XTERM, NOTHING, TerminalOptions(), False, "xterm-256color"),
        (XTERM, NOTHING, TerminalOptions(plain=True), True, "--plain"),
        (XTERM, TerminalFacts(stdin_tty=False), TerminalOptions(), True, "input"),
        (XTERM, TerminalFacts(stdout_tty=False), TerminalOptions(), True, "output"),
        (XTERM, TerminalFacts(stderr_tty=False), TerminalOptions(), True, "error"),
        ({"TERM": "dumb"}, NOTHING, TerminalOptions(), True, "dumb"),
        ({"TERM": "dumb", "COLORTERM": "truecolor"}, NOTHING, TerminalOptions(), True, "dumb"),
        ({"TERM": "unknown"}, NOTHING, TerminalOptions(), True, "unknown"),
        ({"TERM": ""}, NOTHING, TerminalOptions(), True, "not set"),
        ({}, NOTHING, TerminalOptions(), True, "not set"),
        ({"TERM": "linux"}, NOTHING, TerminalOptions(), False, "linux"),
        ({"TERM": "vt100"}, NOTHING, TerminalOptions(), False, "vt100"),
    ],
)
def test_plain(
    environ: dict[str, str], facts: TerminalFacts, wishes: TerminalOptions, plain: bool, why: str
) -> None:
    decision = verdict(environ, facts, wishes).plain
    assert decision.value is plain
    assert why in decision.reason


@every_case(
    ("environ", "encoding", "wish", "glyphs", "why"),
    [
        (XTERM, "utf-8", None, "braille", "utf-8"),
        (XTERM, "utf-8", "ascii", "ascii", "--glyphs ascii"),
        (XTERM, "utf-8", "block", "block", "--glyphs block"),
        (XTERM, "ascii", None, "ascii", "ascii"),
        (XTERM, "latin-1", None, "ascii", "latin-1"),
        (XTERM, "ascii", "braille", "ascii", "encoded"),
        (XTERM, "no such encoding", None, "ascii", "no such"),
        ({"TERM": "linux"}, "utf-8", None, "ascii", "linux"),
        ({"TERM": "linux"}, "utf-8", "block", "block", "--glyphs"),
        ({"TERM": "vt220"}, "utf-8", None, "ascii", "vt220"),
        ({"TERM": "vte-256color"}, "utf-8", None, "braille", "utf-8"),
    ],
)
def test_glyphs(environ: dict[str, str], encoding: str, wish: str | None, glyphs: str, why: str) -> None:
    wishes = TerminalOptions(glyphs=next((choice for choice in GLYPH_CHOICES if choice == wish), None))
    decision = verdict(environ, TerminalFacts(encoding=encoding), wishes).glyphs
    assert decision.value == glyphs
    assert why in decision.reason


@every_case(
    ("environ", "wish", "colour", "why"),
    [
        (XTERM, None, "ansi16", "own 16"),
        (XTERM | {"COLORTERM": "truecolor"}, None, "truecolour", "COLORTERM"),
        (XTERM | {"COLORTERM": "truecolor", "KIT_THEME": "terminal"}, None, "ansi16", "own 16"),
        (XTERM | {"COLORTERM": "truecolor", "KIT_COLOR": "16"}, None, "ansi16", "KIT_COLOR"),
        (XTERM | {"COLORTERM": "truecolor", "NO_COLOR": "1"}, None, "none", "NO_COLOR"),
        ({"TERM": "xterm-kitty"}, None, "truecolour", "xterm-kitty"),
        ({"TERM": "xterm-direct"}, None, "truecolour", "xterm-direct"),
        (XTERM | {"KIT_THEME": "light"}, None, "256", "light"),
        ({"TERM": "xterm", "KIT_THEME": "light"}, None, "ansi16", "16"),
        ({"TERM": "xterm"}, None, "ansi16", "16"),
        ({"TERM": "linux"}, None, "ansi16", "16"),
        ({"TERM": "vt100"}, None, "none", "vt100"),
        ({"TERM": "vt100", "COLORTERM": "truecolor"}, None, "none", "vt100"),
        ({"TERM": "xterm-mono"}, None, "none", "xterm-mono"),
        (XTERM | SSH, None, "ansi16", "own 16"),
        (XTERM | SSH | {"COLORTERM": "24bit"}, None, "truecolour", "COLORTERM"),
        (XTERM | {"NO_COLOR": "1"}, None, "none", "NO_COLOR"),
        (XTERM | {"NO_COLOR": ""}, None, "ansi16", "own 16"),
        (XTERM | SSH | {"NO_COLOR": "1"}, None, "none", "NO_COLOR"),
        (XTERM | {"NO_COLOR": "1"}, "16", "ansi16", "--color 16"),
        (XTERM | SSH, "true", "truecolour", "--color true"),
        (XTERM, "none", "none", "--color none"),
        (XTERM, "256", "256", "--color 256"),
    ],
)
def test_colour(environ: dict[str, str], wish: str | None, colour: str, why: str) -> None:
    decision = verdict(environ, wishes=TerminalOptions(color=wish))
    assert decision.colour.value == colour
    assert why in decision.colour.reason
    assert decision.ansi == (colour in ("none", "ansi16"))


@every_case(
    ("environ", "theme"),
    [
        (XTERM, "terminal"),
        (XTERM | {"COLORFGBG": "0;15"}, "light"),
        (XTERM | {"COLORFGBG": "15;0"}, "terminal"),
        (XTERM | {"COLORFGBG": "0;15", "NO_COLOR": "1"}, "terminal"),
        (XTERM | {"COLORTERM": "truecolor"}, "dark"),
        (XTERM | {"COLORTERM": "truecolor", "COLORFGBG": "0;15"}, "light"),
        (XTERM | {"COLORTERM": "truecolor", "COLORFGBG": "15;0"}, "dark"),
        (XTERM | {"COLORTERM": "truecolor", "COLORFGBG": "0;15", "KIT_THEME": "contrast"}, "contrast"),
        (XTERM | {"COLORTERM": "truecolor", "KIT_THEME": "no such theme"}, "dark"),
        (XTERM | {"KIT_THEME": "colorblind"}, "colorblind"),
        (XTERM | {"KIT_THEME": "colorblind", "NO_COLOR": "1"}, "terminal"),
    ],
)
def test_theme(environ: dict[str, str], theme: str) -> None:
    assert verdict(environ).theme_name.value == theme


@every_case(
    ("environ", "remote", "between", "asked"),
    [
        (XTERM, False, None, True),
        (XTERM | SSH, True, None, True),
        (XTERM | {"SSH_TTY": "/dev/pts/1"}, True, None, True),
        (XTERM | {"SSH_CLIENT": "10.0.0.1 5 22"}, True, None, True),
        ({"TERM": "tmux-256color", "TMUX": "/tmp/tmux,1,0"}, False, "tmux", True),
        ({"TERM": "screen-256color", "TMUX": "/tmp/tmux,1,0"}, False, "tmux", True),
        ({"TERM": "tmux-256color"} | SSH, True, "tmux", True),
        ({"TERM": "screen.xterm-256color", "STY": "1.pts"}, False, "screen", True),
        ({"TERM": "screen"} | SSH, True, "screen", True),
        (XTERM | SSH | {"NCURSES_NO_UTF8_ACS": "1"}, True, "mosh", True),
        (XTERM | {"NCURSES_NO_UTF8_ACS": "1"}, False, None, True),
        ({"TERM": "linux"}, False, None, False),
        ({"TERM": "vt100"}, False, None, False),
        (XTERM | {"TEXTUAL_DISABLE_KITTY_KEY": "1"}, False, None, False),
        (XTERM | {"TEXTUAL_DISABLE_KITTY_KEY": "0"}, False, None, True),
    ],
)
def test_the_way_to_the_terminal(
    environ: dict[str, str], remote: bool, between: str | None, asked: bool
) -> None:
    decision = verdict(environ)
    assert decision.remote.value is remote
    assert decision.between.value == between
    assert decision.ask_keyboard.value is asked


@pytest.mark.parametrize(
    ("value", "is_ours"),
    [(None, False), ("", False), ("0", False), ("off", False), ("1", True), ("yes", True)],
)
def test_the_mouse_is_the_terminals_unless_it_is_asked_for(value: str | None, is_ours: bool) -> None:
    decision = verdict(XTERM if value is None else XTERM | {"KIT_MOUSE": value})
    assert decision.mouse.value is is_ours
    assert "KIT_MOUSE" in decision.mouse.reason


@every_case(("value", "reduced"), [(None, False), ("", False), ("0", False), ("off", False), ("1", True)])
def test_motion_is_reduced_where_it_is_asked_for(value: str | None, reduced: bool) -> None:
    decision = verdict(XTERM if value is None else XTERM | {"KIT_REDUCE_MOTION": value})
    assert decision.reduce_motion.value is reduced
    assert (decision.environment().get("TEXTUAL_ANIMATIONS") == "none") is reduced


@every_case(
    ("size", "room"),
    [
        ((80, 24), "full"),
        ((200, 50), "full"),
        ((79, 24), "compact"),
        ((80, 23), "compact"),
        ((60, 18), "compact"),
        ((59, 50), "too small"),
        ((200, 17), "too small"),
        ((40, 10), "too small"),
        ((1, 1), "too small"),
    ],
)
def test_room(size: tuple[int, int], room: str) -> None:
    decision = verdict(XTERM, TerminalFacts(size=size)).room
    assert decision.value == room
    assert f"{size[0]}x{size[1]}" in decision.reason


@every_case("environ", [{}, XTERM, XTERM | SSH, {"TERM": "linux"}, {"TERM": "tmux-256color", "TMUX": "1"}])
def test_every_decision_has_a_reason_that_is_a_sentence(environ: dict[str, str]) -> None:
    decision = verdict(environ)
    reasons = [
        value.reason
        for field in fields(decision)
        if isinstance(value := getattr(decision, field.name), ReasonedValue)
    ]
    assert len(reasons) == 10
    for reason in reasons:
        assert reason[0].isupper() or reason.startswith(("--", "xterm", "80x", "KIT_"))
        assert reason.endswith(".")


def test_the_facts_of_a_process_without_a_terminal() -> None:
    code = "from kit.tui.terminal import TerminalFacts; print(TerminalFacts.here())"
    run = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, stdin=subprocess.DEVNULL
    )
    assert run.stdout.strip() == repr(
        TerminalFacts(stdin_tty=False, stdout_tty=False, stderr_tty=False, encoding="utf-8", size=(80, 24))
    )


def test_the_facts_of_a_process_in_a_terminal() -> None:
    ours, theirs = pty.openpty()
    termios.tcsetwinsize(theirs, (40, 100))
    code = (
        "from kit.tui.terminal import TerminalFacts; import sys; sys.stderr.write(repr(TerminalFacts.here()))"
    )
    subprocess.run([sys.executable, "-c", code], stdin=theirs, stdout=theirs, stderr=theirs, check=True)
    said = os.read(ours, 10_000).decode()
    os.close(ours)
    os.close(theirs)
    assert said == repr(TerminalFacts(size=(100, 40)))


def test_a_process_with_its_streams_closed_still_gets_an_answer() -> None:
    code = "from kit.tui.terminal import *; import os, sys; print(decide_terminal(os.environ, TerminalFacts.here()).plain.value)"
    script = f'exec "$0" -c "{code}" <&- 2>&-'
    run = subprocess.run(
        ["/bin/sh", "-c", script, sys.executable], capture_output=True, text=True, check=True
    )
    assert run.stdout.strip() == "True"


# What Textual makes of it.

SHOW = """
import os
from kit.tui.terminal import *
decision = decide_terminal(os.environ, TerminalFacts(), TerminalOptions(color=os.environ.pop("WISH")))
os.environ.update(decision.environment())
from kit.tui.app import KitApp
from textual.widgets import Static

class Show(KitApp):
    CSS = "Static { color: $primary; background: $error; }"
    def compose(self):
        yield Static("coloured")
    def on_mount(self):
        self.call_after_refresh(self.set_timer, 0.05, self.exit)

Show(decision).run()
"""


def drawn(settings: dict[str, str]) -> bytes:
    """Everything that the app sends to its terminal."""
    ours, theirs = pty.openpty()
    environ = {name: value for name, value in os.environ.items() if name != "NO_COLOR"} | settings
    child = subprocess.Popen(
        [sys.executable, "-c", SHOW], stdin=theirs, stdout=theirs, stderr=theirs, env=environ
    )
    output = b""
    while select.select([ours], [], [], 0.1)[0] or child.poll() is None:
        if select.select([ours], [], [], 0)[0]:
            output += os.read(ours, 65536)
    os.close(ours)
    os.close(theirs)
    return output


@pytest.mark.long
@pytest.mark.parametrize("wish", COLOUR_CHOICES)
def test_textual_draws_with_the_colours_decided_and_no_others(wish: str) -> None:
    output = drawn({"TERM": "xterm-256color", "COLORTERM": "truecolor", "WISH": wish})
    attributes = set(re.findall(rb"\x1b\[([\d;]*)m", output))
    kinds = {
        "true": {one for one in attributes if b"8;2;" in one},
        "256": {one for one in attributes if b"8;5;" in one},
        "16": {
            one
            for one in attributes
            if re.fullmatch(rb"(\d+;)*([349]|10)[0-7](;\d+)*", one) and b"8;" not in one
        },
    }
    assert b"coloured" in output
    assert {kind for kind, found in kinds.items() if found} == ({wish} if wish != "none" else set())
