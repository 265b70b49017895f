"""``kit layers`` in a real terminal: opens fast, costs nothing while it is looked at, leaves a sane terminal."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests.tui.test_play_pty import KIT, User
from tests.tui.widgets.test_world_view_pty import assert_rests

Open = Callable[..., User]


@pytest.fixture
def layers() -> Iterator[Open]:
    made: list[User] = []

    def run(*arguments: str) -> User:
        user = User(KIT, "layers", *arguments)
        made.append(user)
        user.until(lambda: "What is asked" in user.text, "the case")
        return user

    yield run
    for user in made:
        user.close()


def test_from_the_first_case_to_a_proof_and_out(layers: Open) -> None:
    user = layers()
    user.until(lambda: user.text.startswith("two  1. What is asked"), "two  1. What is asked")
    user.send(b"m")
    user.until(lambda: "slides-lasers" in user.text, "the list")
    user.send(b"slides-l\r")
    user.until(lambda: user.text.startswith("slides-lasers"), "the slides' case")
    user.send(b"2\x1b[C\x1b[C")
    user.until(lambda: "layer 3 of 6" in user.text, "the third clique")
    user.until(lambda: "[M2]" in user.text, "the picture of it")
    user.send(b"3")
    user.until(lambda: "10 layers, and no plan has fewer." in user.text, "the optimum")
    user.send(b"4")
    user.until(lambda: "No two of these 10 fit one layer" in user.text, "the certificate")
    assert_rests(user, 0.07)
    user.send(b"\x1b")
    assert user.wait() == 0
    user.assert_sane()


def test_keys_that_come_at_once_are_not_lost_and_a_page_is_left_with_it(layers: Open) -> None:
    user = layers("example", "three", "--screen")
    user.send(b"e")
    user.until(lambda: user.text.startswith("a case by hand"), "the table")
    user.send(b"1floor\r\r")
    user.until(lambda: "4 floor" in user.text, "a map")
    user.send(b"2cart\r")
    user.until(lambda: "5 cart" in user.text, "a body")
    user.send(b"\x1b")
    user.until(lambda: user.text.startswith("mine"), "the case typed")
    user.until(lambda: "#floor#" in user.text, "#floor#")
    user.send(b"?")
    user.until(lambda: "any key closes" in user.text, "the help")
    user.send(b"x\x03")
    assert user.wait() == 0
    user.assert_sane()


def test_a_worlds_case_by_its_file(layers: Open) -> None:
    world = Path(__file__).parents[2] / "maps" / "depot" / "world.yaml"
    user = layers("explain", str(world), "--screen")
    user.until(lambda: user.text.startswith("world.yaml"), "world.yaml")


def test_without_a_terminal_there_is_the_help_and_a_way_out() -> None:
    def run(*arguments: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, KIT, "layers", *arguments]
        return subprocess.run(
            command, capture_output=True, text=True, timeout=60, env={**os.environ, "TERM": "dumb"}
        )

    alone = run()
    assert alone.returncode == 0
    assert "kit layers explain" in alone.stdout
    asked = run("example", "two", "--screen")
    assert asked.returncode == 2
    assert "kit layers explain two --pictures" in asked.stderr
