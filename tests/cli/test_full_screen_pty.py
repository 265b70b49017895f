"""A full screen that a signal ends has saved what it keeps, and gives the terminal back."""

from __future__ import annotations

import signal
from contextlib import closing
from pathlib import Path

import pytest

from tests.tui.input.conftest import Terminal

pytestmark = [pytest.mark.pty, pytest.mark.long]

PROGRAM = """
import sys
from pathlib import Path
import click
from textual.screen import Screen
from kit.cli import terminal_options
from kit.cli.process import run_as_process
from kit.cli.full_screen import show_screen

class Kept(Screen):
    def on_mount(self):
        Path(folder, "shown").touch()

    def on_unmount(self):
        Path(folder, "kept").touch()

def show():
    show_screen(terminal_options.full_screen("The screen"), lambda app: Kept())

sys.argv, folder = sys.argv[:1], sys.argv[1]
run_as_process(click.Command("show", callback=show), "show")
"""


@pytest.mark.parametrize("sent", ["SIGTERM", "SIGHUP", "hang up"])
def test_a_signal_lets_the_screen_save_what_it_keeps(tmp_path: Path, sent: str) -> None:
    program = tmp_path / "program.py"
    program.write_text(PROGRAM)
    with closing(Terminal(str(program), str(tmp_path))) as terminal:
        terminal.until((tmp_path / "shown").exists, "the screen")
        if sent == "hang up":
            terminal.hang_up()
            terminal.process.wait(60)
        else:
            terminal.process.send_signal(signal.Signals[sent])
            assert terminal.wait() == 128 + signal.Signals[sent]
            terminal.assert_sane()
    assert (tmp_path / "kept").exists()
