"""The world view in a real terminal: a process of its own, Textual's own driver, pyte to look at it."""

from __future__ import annotations

import fcntl
import os
import re
import signal
import struct
import termios
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.tui.input.conftest import Terminal
from tests.tui.tape import Display

PROGRAM = Path(__file__).parents[1] / "programs" / "world_app.py"

# pyte 0.8.2 prints a part of these; a real terminal shows nothing.
KEYBOARD = re.compile(rb"\x1b\[[<>=][\d;]*u")


@pytest.fixture
def terminal() -> Iterator[Terminal]:
    terminal = Terminal(str(PROGRAM))
    yield terminal
    terminal.close()


def shown(terminal: Terminal, columns: int = 80, rows: int = 24, since: int = 0) -> list[str]:
    display = Display(columns, rows)
    display.feed(KEYBOARD.sub(b"", terminal.output[since:]).decode(errors="ignore"))
    return display.rows


def paused(terminal: Terminal) -> list[Any]:
    """Pauses the program: the rows it means to show, its frame rate and the lag it measured."""
    terminal.reports.clear()
    terminal.send(b"p")
    terminal.until(lambda: terminal.reports, "the pause")
    return list(terminal.reports[-1][1:])


def until_shown(terminal: Terminal, columns: int, rows: int, since: int = 0) -> None:
    """Waits until a terminal of this size shows what the program means to show."""
    end = time.monotonic() + 20
    meant = paused(terminal)[0]
    while len(meant) != rows or shown(terminal, columns, rows, since) != meant:
        assert time.monotonic() < end, "\n".join((*meant, *shown(terminal, columns, rows, since)))
        meant = paused(terminal)[0]


def cpu_seconds(pid: int) -> float:
    fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def run_on(terminal: Terminal, seconds: float) -> None:
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        terminal.pump(0.02)


def until_quiet(terminal: Terminal) -> None:
    """Waits until nothing has come for a quarter of a second: five frames."""
    quiet_since = time.monotonic()
    while time.monotonic() < quiet_since + 0.25:
        if terminal.pump(0.02):
            quiet_since = time.monotonic()


def assert_rests(terminal: Terminal, cpu_share: float) -> None:
    """Once quiet, the program sends nothing, and comes to use at most this share of a processor within a few seconds:
    what is imported for later goes on for a while."""
    until_quiet(terminal)
    sent = len(terminal.output)
    for _ in range(5):
        before = cpu_seconds(terminal.process.pid)
        run_on(terminal, 1.0)
        assert len(terminal.output) == sent
        used = cpu_seconds(terminal.process.pid) - before
        if used <= cpu_share:
            break
    assert used <= cpu_share


def test_the_terminal_shows_the_robot_in_its_maze(terminal: Terminal) -> None:
    terminal.until(lambda: "▲".encode() in terminal.output, "the robot")
    run_on(terminal, 1.0)
    until_shown(terminal, 80, 24)
    rows, fps, lag = paused(terminal)
    picture = "\n".join(rows)
    assert "◎" in picture
    assert "▲" in picture
    assert picture.count("█") + picture.count("▌") > 20
    assert fps == (20 if lag < 0.1 else 10)
    assert 0 < lag < 1
    terminal.send(b"q")
    assert terminal.wait() == 0


def test_a_paused_world_sends_nothing_and_costs_next_to_nothing(terminal: Terminal) -> None:
    terminal.until(lambda: "▲".encode() in terminal.output, "the robot")
    paused(terminal)
    assert_rests(terminal, 0.02)


def test_following_close_up_and_another_size(terminal: Terminal) -> None:
    terminal.until(lambda: "▲".encode() in terminal.output, "the robot")
    terminal.send(b"z")
    run_on(terminal, 0.8)
    until_shown(terminal, 80, 24)
    for columns, lines in ((40, 10), (132, 43)):
        since = len(terminal.output)
        fcntl.ioctl(terminal.other_fd, termios.TIOCSWINSZ, struct.pack("HHHH", lines, columns, 0, 0))
        terminal.process.send_signal(signal.SIGWINCH)
        until_shown(terminal, columns, lines, since)
