"""Terminals that are hard on a program: resized without end, several of one user, killed, pasted into, poor in signs or colours."""

from __future__ import annotations

import random
import re
import signal
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests.tui.test_play_pty import KIT, User, resize

pytestmark = [pytest.mark.pty, pytest.mark.long]

RESIZES = 120
COLOURED = re.compile(rb"\x1b\[(?:\d+;)*(?:3[0-7]|4[0-7]|9[0-7]|10[0-7]|38|48)[;m]")
"""What sets a colour of text or background."""

SCREENS = {
    "start": (("start",), b"", "Lessons"),
    "drive": (("drive", "simple"), b"", "forward"),
    "robot's map": (("drive", "simple"), b"u", "forward"),
    "editor": (("drive", "simple"), b"\x05", "rclpy"),
    "levels": (("game",), b"", "First drive"),
    "level": (("game", "play", "first-drive"), b"", "The clock starts"),
    "lesson": (("lesson", "1"), b"", "Predict"),
    "nodes": (("drive", "simple"), b"n", "static_laser"),
    "form": (("form",), b"", "highest education"),
    "trainings": (("train",), b"", "Choose a task"),
}
"""By name: the command, keys after its first picture, and words that are on the screen then."""

UNSEEN = re.compile("([⠄']) \\1 \\1 ")
"""How a row of places is drawn that the robot has not seen, with and without signs."""

Open = Callable[..., User]


@pytest.fixture
def kit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Open]:
    """Runs ``kit`` in a terminal of its own, in one workspace for all."""
    monkeypatch.setenv("KIT_WORKSPACE", str(tmp_path / "home"))
    made: list[User] = []

    def run(*arguments: str, **environment: str) -> User:
        made.append(User(KIT, *arguments, environment=environment))
        return made[-1]

    yield run
    for terminal in made:
        terminal.close()


def opened(kit: Open, name: str, **environment: str) -> User:
    arguments, keys, words = SCREENS[name]
    terminal = kit(*arguments, **environment)
    if keys:
        terminal.until(lambda: "0:0" in terminal.text, "the world")
        terminal.send(keys)
    terminal.until(lambda: words in terminal.text, words)
    if name == "robot's map":
        terminal.until(lambda: UNSEEN.search(terminal.text), "places that the robot has not seen")
    return terminal


@pytest.mark.parametrize("name", SCREENS)
def test_it_outlives_a_storm_of_resizes(kit: Open, name: str) -> None:
    terminal = opened(kit, name)
    chance = random.Random(name)
    for _ in range(RESIZES):
        resize(terminal, chance.randint(10, 200), chance.randint(3, 50))
        terminal.pump(0.01)
        assert terminal.process.poll() is None
    resize(terminal, 80, 24)
    terminal.until(lambda: SCREENS[name][2] in terminal.text, "the screen as it was")
    terminal.send(b"\x03")
    assert terminal.wait() == 0
    terminal.assert_sane()


def test_four_sessions_of_one_user_do_not_disturb_each_other(kit: Open) -> None:
    sessions = [opened(kit, name) for name in ("start", "levels", "editor", "lesson")]
    sessions[2].send(b"# a line\r\x13")
    sessions[2].until(lambda: "saved" in sessions[2].text, "the program to be saved")
    sessions[0].send(b"2")
    sessions[0].until(lambda: "Enter open" in sessions[0].text, "the lessons")
    sessions[1].send(b"\r")
    sessions[1].until(lambda: "The clock starts" in sessions[1].text, "the level")
    sessions[3].send(b"1")
    for terminal in sessions:
        terminal.pump(0.05)
        assert terminal.process.poll() is None
        terminal.send(b"\x03")
        assert terminal.wait() == 0
        terminal.assert_sane()


@pytest.mark.parametrize("sent", [signal.SIGTERM, signal.SIGHUP])
@pytest.mark.parametrize("name", ["start", "editor", "levels", "lesson"])
def test_a_signal_leaves_a_sane_terminal(kit: Open, name: str, sent: signal.Signals) -> None:
    terminal = opened(kit, name)
    terminal.process.send_signal(sent)
    assert terminal.wait() in (-sent, 128 + sent)
    terminal.assert_sane()


@pytest.mark.parametrize("name", ["start", "levels", "drive", "lesson"])
def test_what_is_pasted_does_nothing(kit: Open, name: str) -> None:
    terminal = opened(kit, name)
    terminal.send(b"\x1b[200~rm -rf q\r2345 wasd xyz\x03\x1b[201~")
    terminal.send(b"?")  # answered after what was pasted
    terminal.until(lambda: "any key closes" in terminal.text, "help")
    terminal.send(b"\x1b")
    terminal.until(
        lambda: "any key closes" not in terminal.text and SCREENS[name][2] in terminal.text, "the same screen"
    )
    assert terminal.process.poll() is None


def test_what_is_pasted_into_the_editor_is_text(kit: Open) -> None:
    terminal = opened(kit, "editor")
    terminal.send(b"\x1b[200~# pasted q\x03\x1b[201~")
    terminal.until(lambda: "# pasted q" in terminal.text, "the text")


def test_a_dumb_terminal_gets_lines(kit: Open) -> None:
    terminal = kit("drive", "simple", TERM="dumb", COLORTERM="truecolor")
    terminal.until(lambda: "line by line" in terminal.output.decode(errors="replace"), "the line mode")
    assert b"\x1b" not in terminal.output


POOR = {
    "linux": {"TERM": "linux"},
    "without UTF-8": {"LANG": "C", "LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"},
}


@pytest.mark.parametrize("name", ["start", "drive", "robot's map", "levels", "editor"])
@pytest.mark.parametrize("poor", POOR)
def test_a_terminal_without_signs_gets_ascii(kit: Open, poor: str, name: str) -> None:
    terminal = opened(kit, name, **POOR[poor])
    if name != "levels":
        terminal.until(lambda: "#" in terminal.text, "walls")
    assert {byte for byte in terminal.output if byte > 126} == set()
    terminal.send(b"\x03")
    assert terminal.wait() == 0


@pytest.mark.parametrize("name", ["start", "drive", "robot's map", "levels", "editor", "lesson"])
def test_no_color_means_none(kit: Open, name: str) -> None:
    terminal = opened(kit, name, NO_COLOR="1", COLORTERM="truecolor")
    terminal.pump(0.3)
    found = COLOURED.search(terminal.output)
    assert found is None, found
