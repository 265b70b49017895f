"""Asking a terminal from the command line: the answer, the time limit, and a terminal left as it was."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable
from typing import Any

import pytest

from kit.tui.input.protocol import ask_keyboard

Run = Callable[..., Any]


@pytest.mark.parametrize(
    ("traits", "flags", "releases"),
    [
        ({}, 27, True),
        ({"kitty": False}, None, False),
        ({"attributes": b"\x1b[?61;4;6;7;14;21;22;23;24;28;32;42;52c"}, 27, True),
    ],
)
def test_the_answer(terminal: Run, traits: dict[str, object], flags: int | None, releases: bool) -> None:
    program = terminal("asks.py", "10", **traits)
    assert program.wait() == 0
    (report,) = program.reports
    assert (report["flags"], report["releases"]) == (flags, releases)
    assert 0 <= report["seconds"] < 10
    program.assert_sane()


@pytest.mark.long
def test_a_silent_terminal_is_given_up(terminal: Run) -> None:
    program = terminal("asks.py", "0.2", kitty=False, attributes=None)
    assert program.wait() == 0
    assert program.reports == [{"flags": None, "seconds": None, "releases": False}]
    program.assert_sane()


def test_ctrl_c_while_it_waits(terminal: Run) -> None:
    program = terminal("asks.py", "600", kitty=False, attributes=None)
    program.until(lambda: program.output, "the question")
    program.send(b"\x03")
    assert program.wait() in {-signal.SIGINT, 1, 130}
    program.assert_sane()


def test_without_a_terminal_there_is_nobody_to_ask() -> None:
    reader, writer = os.pipe()
    with pytest.raises(OSError, match="ioctl"):
        ask_keyboard(reader, writer)
    os.close(reader)
    os.close(writer)
