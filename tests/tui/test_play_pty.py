"""A user at the play screen, in a real terminal: the kit as it is installed, keys in, characters out."""

from __future__ import annotations

import fcntl
import re
import signal
import struct
import termios
from codecs import getincrementaldecoder
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import MappingProxyType
from typing import Any

import pytest

import kit as kit_package
from kit.controllers import find_controller
from kit.run.headless import run_headless
from kit.run.recording import load_recording, rerun
from kit.run.recording_file import RecordingFile
from kit.run.scenario import find_scenario
from tests.driving_program import driving_program
from tests.run.test_connection_watch import DEAF, WORLD, tells_of_both
from tests.tui.input.conftest import Terminal
from tests.tui.tape import Display
from tests.tui.widgets.test_world_view_pty import assert_rests, run_on

ROBOT = re.compile("[►◥▲◤◄◣▼◢]")
KIT = str(Path(kit_package.__file__).with_name("__main__.py"))
KEYBOARD = re.compile(rb"\x1b\[[<>=][\d;]*u")
"""pyte prints a part of these; a real terminal shows nothing."""


class User(Terminal):
    """A terminal with somebody in front of it, who reads as it comes."""

    def __init__(
        self, *program: str, kitty: bool = True, environment: Mapping[str, str] = MappingProxyType({})
    ) -> None:
        super().__init__(*program, kitty=kitty, environment=environment)
        self.resize_and_look(80, 24)
        self._read = 0

    def resize_and_look(self, columns: int, rows: int) -> None:
        """At a screen of this size, on which nothing stands yet."""
        self._display = Display(columns, rows)
        self._decode = getincrementaldecoder("utf-8")("replace").decode
        self._read = len(self.output)

    @property
    def text(self) -> str:
        new = self.output[self._read :]
        cut = new.rfind(b"\x1b", -32)  # a sequence may be under way
        whole = new if cut < 0 else new[:cut]
        self._read += len(whole)
        self._display.feed(self._decode(KEYBOARD.sub(b"", whole)))
        return "\n".join(self._display.rows)


Open = Callable[..., User]


@contextmanager
def terminals() -> Iterator[Open]:
    """Runs ``kit``, each in a terminal of its own; closes them all. Takes the options of ``User``."""
    made: list[User] = []

    def run(*arguments: str, **options: Any) -> User:
        made.append(User(KIT, *arguments, **options))
        return made[-1]

    try:
        yield run
    finally:
        for terminal in made:
            terminal.close()


@pytest.fixture
def kit() -> Iterator[Open]:
    """Runs ``kit`` in a terminal of its own and waits until its world is on the screen."""
    with terminals() as run:

        def run_until(*arguments: str, ready: str = "0:0", kitty: bool = True) -> User:
            terminal = run(*arguments, kitty=kitty)
            terminal.until(lambda: ready in terminal.text, ready)
            return terminal

        yield run_until


def resize(terminal: User, columns: int, rows: int) -> None:
    terminal.resize_and_look(columns, rows)
    fcntl.ioctl(terminal.other_fd, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
    terminal.process.send_signal(signal.SIGWINCH)


def test_the_robot_walks_by_itself_and_an_arrow_key_takes_over(kit: Open) -> None:
    terminal = kit("drive", "--seed", "1", kitty=False)
    terminal.until(lambda: "random_walk" in terminal.text, "random_walk")
    terminal.until(lambda: ROBOT.search(terminal.text), "a robot")
    terminal.until(lambda: "forward   0.50" in terminal.text, "the robot on its way")
    terminal.send(b"\x1b[A")
    terminal.until(lambda: "teleop" in terminal.text, "the takeover")
    terminal.until(
        lambda: "forward   0.00" in terminal.text, "the robot to stop, for the key does not repeat"
    )
    terminal.send(b"g")
    terminal.until(lambda: "random_walk" in terminal.text, "the controller to drive again")
    terminal.send(b"\x03")
    assert terminal.wait() == 0
    terminal.assert_sane()


def test_holding_an_exact_key_drives_until_it_is_released(kit: Open) -> None:
    terminal = kit("drive", "simple", "--controller", "teleop")
    terminal.until(lambda: "exact" in terminal.text, "the terminal's answer")
    terminal.send(b"\x1b[1;1:1A")
    terminal.until(lambda: "forward   0.50" in terminal.text, "full speed")
    terminal.send(b"\x1b[1;1:3A")
    terminal.until(lambda: "forward   0.00" in terminal.text, "the stop")


def test_nothing_is_sent_while_paused(kit: Open) -> None:
    terminal = kit("drive")
    terminal.send(b"p")
    terminal.until(lambda: "paused" in terminal.text, "the pause")
    assert_rests(terminal, 0.07)
    clock = re.search(r"\d:\d\d\.\d\d", terminal.text)
    assert clock is not None
    terminal.send(b".")
    terminal.until(lambda: clock[0] not in terminal.text, "a step")
    terminal.send(b"p")
    terminal.until(lambda: "speed x1" in terminal.text, "the world to go on")


def test_speeds_change_while_running(kit: Open) -> None:
    terminal = kit("drive")
    for key, name in ((b"2", "speed x10"), (b"3", "speed max"), (b"1", "speed x1 ")):
        terminal.send(key)
        terminal.until(lambda name=name: name in terminal.text, name)  # type: ignore[misc]  # mypy on lambdas


def test_a_map_and_a_controller_are_chosen_by_name(kit: Open) -> None:
    terminal = kit("drive")
    terminal.send(b"m")
    terminal.until(lambda: "Maps" in terminal.text, "the list of maps")
    terminal.send(b"roundab\r")
    terminal.until(lambda: "roundabout" in terminal.text.splitlines()[0], "the roundabout")
    terminal.send(b"c")
    terminal.until(lambda: "Controllers" in terminal.text, "the list of controllers")
    terminal.send(b"circle\r")
    terminal.until(lambda: "turning   1.00" in terminal.text, "the circle")
    terminal.send(b"?")
    terminal.until(lambda: "any key closes" in terminal.text, "the help")
    terminal.send(b"x")
    terminal.until(lambda: "any key closes" not in terminal.text, "the world again")


def test_a_saved_controller_is_read_again_and_a_broken_one_leaves_the_old_one_running(
    kit: Open, tmp_path: Path
) -> None:
    file = tmp_path / "mine.py"
    file.write_text(driving_program(turning=0.5))
    terminal = kit("drive", "simple", "--controller", str(file))
    terminal.until(lambda: "turning   0.50" in terminal.text, "the controller at work")
    file.write_text(driving_program(turning=-0.25))
    terminal.until(lambda: "turning  -0.25" in terminal.text, "the new version")
    broken = driving_program(turning="(")
    file.write_text(broken)
    line = broken.splitlines().index("        command.angular.z = (") + 1
    terminal.until(lambda: f"mine.py:{line}" in terminal.text, "the error with file and line")
    terminal.until(lambda: "turning  -0.25" in terminal.text, "turning  -0.25")
    file.write_text(driving_program(then="raise RuntimeError('no')"))
    terminal.until(lambda: "RuntimeError: no" in terminal.text, "the failure")
    clock = re.search(r"\d:\d\d\.\d", terminal.text)
    assert clock is not None
    terminal.until(lambda: clock[0] not in terminal.text, "the world to go on all the same")
    file.write_text(driving_program(turning=0.75))
    terminal.until(lambda: "turning   0.75" in terminal.text, "the repaired version")
    terminal.until(lambda: "RuntimeError: no" not in terminal.text, "the failure to be forgotten")


@pytest.mark.parametrize(("name", "sent"), [("SIGTERM", signal.SIGTERM), ("SIGHUP", signal.SIGHUP)])
def test_a_signal_leaves_a_sane_terminal(kit: Open, name: str, sent: signal.Signals) -> None:
    terminal = kit("drive")
    terminal.process.send_signal(sent)
    assert terminal.wait() != 0
    terminal.assert_sane()


def test_a_storm_of_sizes_changes_nothing_but_the_size(kit: Open) -> None:
    terminal = kit("drive")
    for columns, rows in [(40, 10), (200, 50), (1, 1), (80, 3), (3, 24), (120, 40)] * 4:
        resize(terminal, columns, rows)
        terminal.pump(0.01)
    resize(terminal, 80, 24)
    terminal.until(lambda: "nearest" in terminal.text, "the whole screen again")
    terminal.send(b"\x03")
    assert terminal.wait() == 0
    terminal.assert_sane()


def test_a_controller_that_hears_nothing_is_told_of_in_80_columns(kit: Open, tmp_path: Path) -> None:
    file = tmp_path / "deaf.py"
    file.write_text(DEAF)
    terminal = kit("drive", str(WORLD), "--controller", str(file))
    terminal.until(lambda: tells_of_both(terminal.text), "what it says and what there is")
    terminal.send(b"\x03")
    assert terminal.wait() == 0


def test_a_small_terminal_gives_its_room_to_the_world(kit: Open) -> None:
    terminal = kit("drive")
    resize(terminal, 40, 10)
    run_on(terminal, 0.5)
    assert "nearest" not in terminal.text
    terminal.until(lambda: ROBOT.search(terminal.text), "the robot")
    terminal.send(b"\x03")
    assert terminal.wait() == 0


def test_a_world_with_errors_says_so_and_leaves_the_way_out(kit: Open, tmp_path: Path) -> None:
    world = tmp_path / "world.yaml"
    world.write_text("properties: {}\nlayers: []\nmodles: []\n")
    terminal = kit("drive", str(world), ready="world.yaml:3")
    terminal.until(lambda: "models" in terminal.text and "any key closes" in terminal.text, "what is wrong")
    terminal.send(b" ")
    terminal.until(lambda: "any key closes" not in terminal.text, "the empty screen")
    terminal.send(b"m")
    terminal.until(lambda: "Maps" in terminal.text, "the list of maps")
    terminal.send(b"maze\r")
    terminal.until(lambda: ROBOT.search(terminal.text), "the maze")
    terminal.send(b"\x03")
    assert terminal.wait() == 0


def test_ascii_glyphs_mean_ascii_everywhere(kit: Open) -> None:
    terminal = kit("drive", "--glyphs", "ascii")
    terminal.until(lambda: re.search("[<>^v]", terminal.text), "the robot")
    terminal.send(b"?")
    terminal.until(lambda: "any key closes" in terminal.text, "the help")
    assert terminal.text.isascii()


def test_a_recorded_run_is_watched_again_and_stands_still_at_its_end(kit: Open, tmp_path: Path) -> None:
    file = tmp_path / "run.npz"
    run_headless(
        find_scenario("maze"), find_controller("random_walk"), steps=60, seed=2, record=RecordingFile(file)
    )
    terminal = kit("replay", str(file))
    terminal.until(lambda: "run.npz" in terminal.text or "maze" in terminal.text, "run.npz")
    terminal.until(lambda: "0:00.60" in terminal.text, "the end")
    terminal.until(lambda: "paused" in terminal.text, "paused")
    terminal.send(b"r")
    terminal.until(lambda: "0:00.60" not in terminal.text, "the beginning")
    terminal.until(lambda: "0:00.60" in terminal.text, "the end again")


def test_what_the_keys_drove_is_kept_when_one_leaves(kit: Open, tmp_path: Path) -> None:
    file = tmp_path / "drive.npz"
    terminal = kit("drive", "simple", "--controller", "teleop", "--record", str(file))
    terminal.until(lambda: "exact" in terminal.text, "the terminal's answer")
    terminal.send(b"\x1b[1;1:1A")
    terminal.until(lambda: "forward   0.50" in terminal.text, "full speed")
    terminal.send(b"r\x03")
    assert terminal.wait() == 0, terminal.text
    recording = load_recording(file)
    assert (recording.place, recording.case) == ("simple", "simple")
    assert (rerun(recording, find_scenario("simple").world).poses == recording.poses).all()


def test_the_keys_drive_a_robot_in_a_namespace(kit: Open) -> None:
    terminal = kit("drive", "pair_straight", "--controller", "teleop")
    terminal.until(lambda: "exact" in terminal.text, "the terminal's answer")
    terminal.send(b"\x1b[1;1:1A")
    terminal.until(lambda: "forward   0.50" in terminal.text, "full speed")


@pytest.mark.parametrize("key", [b"?", b"m", b"c", b"n"])
def test_ctrl_c_leaves_from_wherever_one_is(kit: Open, key: bytes) -> None:
    terminal = kit("drive")
    terminal.send(key)
    run_on(terminal, 0.5)
    terminal.send(b"\x03")
    assert terminal.wait() == 0
    terminal.assert_sane()


@pytest.mark.long
@pytest.mark.parametrize("plain", [(), ("--plain",)])
@pytest.mark.parametrize("sent", ["SIGTERM", "SIGHUP", "SIGTERM SIGTERM", "hang up"])
def test_every_end_keeps_the_drive(kit: Open, tmp_path: Path, sent: str, plain: tuple[str, ...]) -> None:
    file = tmp_path / "drive.npz"
    words = ("drive", "simple", "--controller", "random_walk", "--record", str(file), *plain)
    if plain:
        terminal = kit(*words, ready="Type help")
        terminal.send(b"run 2\n")
        terminal.until(lambda: "at 0:02.0" in terminal.text, "the end of the run")
    else:
        terminal = kit(*words)
        clock = re.search(r"\d:\d\d\.\d", terminal.text)
        assert clock is not None
        terminal.until(lambda: clock[0] not in terminal.text, "the world's time to pass")
    if sent == "hang up":
        terminal.hang_up()
        terminal.process.wait(60)
    else:
        for name in sent.split():
            terminal.process.send_signal(signal.Signals[name])
        assert terminal.wait() in ({128 + signal.Signals[sent]} if " " not in sent else {143, -15})
        terminal.assert_sane()
    if " " not in sent or file.exists():
        assert load_recording(file).ticks > 0
