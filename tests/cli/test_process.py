"""The end of a command: quick, and yet nothing is lost."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from kit.cli.lazy_group import LazyGroup
from kit.cli.process import INTERRUPTED

PROGRAM = """
import atexit, sys, threading, time
import click
from kit.cli.lazy_group import LazyGroup
from kit.cli.process import run_as_process

class Slow:
    def __del__(self):
        print("taken apart")

SLOW = Slow()

def late(name):
    time.sleep(0.2)
    open(name, "w").write("late")

@click.group(cls=LazyGroup, verbs={"verb": ("__main__:verb", "")})
def command():
    pass

@click.command()
@click.argument("name")
@click.argument("code", type=int)
def verb(name, code):
    atexit.register(lambda: print("at exit"))
    threading.Thread(target=late, args=(name,)).start()
    sys.stdout.write("said, without an end of line ")
    raise KeyboardInterrupt if code == 130 else SystemExit(code)  # 130: Ctrl-C

run_as_process(command, "command")
"""


@pytest.mark.parametrize("code", [0, 1, 2, 3, 130, 143])
def test_a_command_ends_without_being_taken_apart_once_all_is_written(tmp_path: Path, code: int) -> None:
    file = tmp_path / "late.txt"
    command = [sys.executable, "-c", PROGRAM, "verb", str(file), str(code)]
    ended = subprocess.run(command, capture_output=True, text=True, check=False)
    assert ended.returncode == code, ended.stderr
    assert ended.stdout == "said, without an end of line at exit\n"
    assert file.read_text() == "late", "the thread was waited for"


def interrupt() -> None:
    raise KeyboardInterrupt


def abort() -> None:
    raise click.Abort


def interrupt_a_class() -> None:
    """As while a module is imported: before Python 3.12 another error hides the interruption."""

    class Interrupted:
        def __set_name__(self, owner: type, name: str) -> None:
            raise KeyboardInterrupt

    type("Made", (), {"field": Interrupted()})


@pytest.mark.parametrize("end", [interrupt, abort, interrupt_a_class])
def test_an_interruption_that_no_verb_tells_is_a_sentence(end: Callable[[], None]) -> None:
    @click.command()
    def work() -> None:
        end()

    class Group(LazyGroup):
        def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command:
            return work

    ended = CliRunner().invoke(Group(name="kit", verbs={}), ["work"])
    assert ended.exit_code == INTERRUPTED
    assert "interrupted" in ended.output
    assert "Aborted" not in ended.output
