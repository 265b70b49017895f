"""The guard alone, in a real pseudo-terminal: a sane terminal however a process ends that can still run code."""

from __future__ import annotations

import os
import signal
import termios
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import pytest

from kit.tui.input.driver import FATAL, restore_terminal

Run = Callable[..., Any]


@pytest.mark.parametrize("number", FATAL)
@pytest.mark.parametrize("way", ["wait", "threads"])
def test_a_fatal_signal(terminal: Run, number: signal.Signals, way: str) -> None:
    app = terminal("guarded.py", way)
    app.until_reported("taken")
    os.kill(app.process.pid, number)
    assert app.wait() == -number
    app.assert_sane()
    assert b"frame" not in app.output.rpartition(b"\x1b[?1049l")[2]


@pytest.mark.parametrize(("way", "status"), [("error", 1), ("exit", 5), ("ignored", 6)])
def test_an_end_without_a_signal(terminal: Run, way: str, status: int) -> None:
    app = terminal("guarded.py", way)
    assert app.wait() == status
    app.assert_sane()


def test_the_terminal_is_restored_before_another_handler_runs(terminal: Run) -> None:
    app = terminal("guarded.py", "handled")
    app.until_reported("taken")
    os.kill(app.process.pid, signal.SIGTERM)
    assert app.wait() == 7
    app.assert_sane()


def test_disarmed_it_does_nothing(terminal: Run) -> None:
    app = terminal("guarded.py", "disarmed")
    assert app.wait() == 0
    assert app.modes.alternate
    assert termios.tcgetattr(app.other_fd) != app.attributes_before


def test_a_closed_output_is_no_error(terminal: Run) -> None:
    app = terminal("guarded.py", "closed")
    assert app.wait() == 8
    assert termios.tcgetattr(app.other_fd) == app.attributes_before


def test_a_terminal_that_takes_nothing_does_not_hold_us() -> None:
    ours, theirs = os.openpty()
    before = termios.tcgetattr(theirs)
    os.set_blocking(theirs, False)
    with suppress(BlockingIOError):
        while True:
            os.write(theirs, b"x" * 4096)
    os.set_blocking(theirs, True)
    restore_terminal(theirs, theirs, before)
    os.close(ours)
    restore_terminal(theirs, theirs, before)
    os.close(theirs)
    restore_terminal(theirs, theirs, before)


def test_what_is_no_terminal_is_left_alone() -> None:
    reader, writer = os.pipe()
    restore_terminal(reader, writer, None)
    assert os.read(reader, 1000).endswith(b"\x1b[?25h")
    os.close(reader)
    restore_terminal(writer, writer, None)
    os.close(writer)
