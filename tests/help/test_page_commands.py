"""Every command of the pages does what a reader expects: it runs, in the order of its page, in a new home."""

from __future__ import annotations

import subprocess
from collections.abc import Iterator
from contextlib import ExitStack
from functools import partial
from pathlib import Path

import pytest

from kit.help.topic import topic_names
from kit.learning.training.run_folders import find_run, list_runs
from tests.help.page_commands import (
    NAMES,
    NOT_RUN,
    PREPARED,
    WAYS,
    Way,
    commands_in_blocks,
    commands_in_sentences,
    every_command,
    unknown_options,
)
from tests.pasted_commands import LIMIT_S, Home
from tests.waiting import wait_until

PATIENCE_S = 1500


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Home]:
    made = Home(tmp_path / "home", monkeypatch)
    yield made
    for training in list_runs(made.workspace.runs):
        if training.is_active:
            training.send_command("stop")
            wait_until(partial(_has_ended, made, training.name), "the end of the training")


def _has_ended(home: Home, name: str) -> bool:
    return not find_run(home.workspace.runs, name).is_active


def test_the_ways_are_those_of_commands_on_pages() -> None:
    shown = {
        each for name in topic_names() for each in (*commands_in_blocks(name), *commands_in_sentences(name))
    }
    assert {*WAYS, *NOT_RUN, *NAMES} - shown == set()


@pytest.mark.parametrize("name", topic_names())
def test_every_command_and_option_of_a_page_exists(name: str) -> None:
    for text in (*commands_in_blocks(name), *commands_in_sentences(name)):
        assert unknown_options(text) == set(), text


@pytest.mark.pty
@pytest.mark.long
@pytest.mark.timeout(PATIENCE_S)
@pytest.mark.parametrize("name", [name for name, found in every_command().items() if found])
def test_every_command_of_a_page_runs(home: Home, name: str) -> None:
    for prepare in PREPARED.get(name, ()):
        prepare(home.folder)
    with ExitStack() as worlds:
        world = None
        for command in every_command()[name]:
            match WAYS.get(command, Way.ENDS):
                case Way.SCREEN:
                    with home.paste(command) as pasted:
                        pasted.until_screen()
                        pasted.leave()
                        pasted.assert_ended_well(LIMIT_S)
                case Way.SERVES:
                    world = worlds.enter_context(home.paste(command))
                case Way.ASKS | Way.LISTENS:
                    assert world is not None
                    assert home.ask(command, world, lambda printed: bool(printed.strip()))
                case Way.TRAINS:
                    _run(home, command)
                    run = command.split("--name ")[1].split()[0]
                    wait_until(partial(_has_ended, home, run), "the end of the training", limit_s=LIMIT_S)
                case _:
                    if world is not None:
                        worlds.close()
                        world = None
                    _run(home, command)


def _run(home: Home, command: str) -> None:
    ended = subprocess.run(
        ["bash", "-c", command],
        cwd=home.folder,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        check=False,
        timeout=LIMIT_S,
    )
    assert ended.returncode == 0, f"{command}\n{ended.stdout[-1500:]}\n{ended.stderr[-1500:]}"
    assert "Traceback" not in ended.stderr
