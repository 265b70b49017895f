"""A user at the play screen, in a real terminal: the kit as it is installed, keys in, characters out."""

from __future__ import annotations

import fcntl
import re
import signal
import struct
import termios
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

import kit as kit_package

from tests.tui.input.conftest import Terminal
from tests.tui.test_world_view_pty import run_on, shown

ROBOT = re.compile("[►◥▲◤◄◣▼◢]")
CONTROLLER = """
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Mine(Node):
    def __init__(self):
        super().__init__("mine")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(0.1, self.go)

    def go(self):
        command = Twist()
        command.angular.z = 0.5
        {line}
        self.drive.publish(command)
"""

KIT = str(Path(kit_package.__file__).with_name("__main__.py"))
Open = Callable[..., Terminal]


@pytest.fixture
def kit() -> Iterator[Open]:
    """Runs ``kit`` in a terminal of its own and waits until its world is on the screen."""
    made: list[Terminal] = []

    def run(*arguments: str, ready: str = "0:0", **traits: object) -> Terminal:
        terminal = Terminal(KIT, *arguments, **traits)  # type: ignore[arg-type]  # handed on as they come
        made.append(terminal)
        terminal.until(lambda: ready in text(terminal), ready)
        return terminal

    yield run
    for terminal in made:
        terminal.close()


def text(terminal: Terminal, columns: int = 80, rows: int = 24) -> str:
    return "\n".join(shown(terminal, columns, rows))


def resize(terminal: Terminal, columns: int, rows: int) -> None:
    fcntl.ioctl(terminal.other_fd, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
    terminal.process.send_signal(signal.SIGWINCH)


def test_the_robot_walks_by_itself_and_an_arrow_key_takes_over(kit: Open) -> None:
    terminal = kit("play", "--seed", "1", kitty=False)
    assert "random_walk" in text(terminal)
    terminal.until(lambda: ROBOT.search(text(terminal)), "a robot")
    terminal.until(lambda: "forward   0.50" in text(terminal), "the robot on its way")
    terminal.send(b"\x1b[A")
    terminal.until(lambda: "teleop" in text(terminal), "the takeover")
    terminal.until(lambda: "forward   0.00" in text(terminal), "the robot to stop, for the key does not repeat")
    terminal.send(b"g")
    terminal.until(lambda: "random_walk" in text(terminal), "the controller to drive again")
    terminal.send(b"\x03")
    assert terminal.wait() == 0
    terminal.assert_sane()


def test_holding_an_exact_key_drives_until_it_is_released(kit: Open) -> None:
    terminal = kit("play", "simple", "--controller", "teleop")
    terminal.until(lambda: "exact" in text(terminal), "the terminal's answer")
    terminal.send(b"\x1b[1;1:1A")
    terminal.until(lambda: "forward   0.50" in text(terminal), "full speed")
    terminal.send(b"\x1b[1;1:3A")
    terminal.until(lambda: "forward   0.00" in text(terminal), "the stop")


def test_nothing_is_sent_while_paused(kit: Open) -> None:
    terminal = kit("play")
    terminal.send(b"p")
    terminal.until(lambda: "paused" in text(terminal), "the pause")
    run_on(terminal, 0.7)
    before = len(terminal.output)
    run_on(terminal, 1.5)
    assert len(terminal.output) == before
    clock = re.search(r"\d:\d\d\.\d\d", text(terminal))
    assert clock is not None
    terminal.send(b".")
    terminal.until(lambda: clock[0] not in text(terminal), "a step")
    terminal.send(b"p")
    terminal.until(lambda: "speed x1" in text(terminal), "the world to go on")


def test_speeds_change_while_running(kit: Open) -> None:
    terminal = kit("play")
    for key, name in ((b"2", "speed x10"), (b"3", "speed max"), (b"1", "speed x1 ")):
        terminal.send(key)
        terminal.until(lambda name=name: name in text(terminal), name)  # type: ignore[misc]  # mypy on lambdas


def test_a_map_and_a_controller_are_chosen_by_name(kit: Open) -> None:
    terminal = kit("play")
    terminal.send(b"m")
    terminal.until(lambda: "Maps" in text(terminal), "the list of maps")
    terminal.send(b"roundab\r")
    terminal.until(lambda: "roundabout" in text(terminal).splitlines()[0], "the roundabout")
    terminal.send(b"c")
    terminal.until(lambda: "Controllers" in text(terminal), "the list of controllers")
    terminal.send(b"circle\r")
    terminal.until(lambda: "turning   1.00" in text(terminal), "the circle")
    terminal.send(b"?")
    terminal.until(lambda: "any key leaves" in text(terminal), "the help")
    terminal.send(b"x")
    terminal.until(lambda: "any key leaves" not in text(terminal), "the world again")


def test_a_saved_controller_is_read_again_and_a_broken_one_leaves_the_old_one_running(
    kit: Open, tmp_path: Path
) -> None:
    file = tmp_path / "mine.py"
    file.write_text(CONTROLLER.format(line="pass"))
    terminal = kit("play", "simple", "--controller", str(file))
    terminal.until(lambda: "turning   0.50" in text(terminal), "the controller at work")
    file.write_text(CONTROLLER.format(line="command.angular.z = -0.25"))
    terminal.until(lambda: "turning  -0.25" in text(terminal), "the new version")
    file.write_text(CONTROLLER.format(line="command.angular.z = ("))
    terminal.until(lambda: "mine.py:16" in text(terminal), "the error with file and line")
    assert "turning  -0.25" in text(terminal)
    file.write_text(CONTROLLER.format(line="raise RuntimeError('no')"))
    terminal.until(lambda: "RuntimeError: no" in text(terminal), "the failure")
    clock = re.search(r"\d:\d\d\.\d", text(terminal))
    assert clock is not None
    terminal.until(lambda: clock[0] not in text(terminal), "the world to go on all the same")
    file.write_text(CONTROLLER.format(line="command.angular.z = 0.75"))
    terminal.until(lambda: "turning   0.75" in text(terminal), "the repaired version")
    assert "RuntimeError" not in text(terminal)


@pytest.mark.parametrize(("name", "sent"), [("SIGTERM", signal.SIGTERM), ("SIGHUP", signal.SIGHUP)])
def test_a_signal_leaves_a_sane_terminal(kit: Open, name: str, sent: signal.Signals) -> None:
    terminal = kit("play")
    terminal.process.send_signal(sent)
    assert terminal.wait() != 0
    terminal.assert_sane()


def test_a_storm_of_sizes_changes_nothing_but_the_size(kit: Open) -> None:
    terminal = kit("play")
    for columns, rows in [(40, 10), (200, 50), (1, 1), (80, 3), (3, 24), (120, 40)] * 4:
        resize(terminal, columns, rows)
        terminal.pump(0.01)
    resize(terminal, 80, 24)
    start = len(terminal.output)
    terminal.until(lambda: "nearest" in "\n".join(shown(terminal, since=start)), "the whole screen again")
    terminal.send(b"\x03")
    assert terminal.wait() == 0
    terminal.assert_sane()


def test_a_small_terminal_gives_its_room_to_the_world(kit: Open) -> None:
    terminal = kit("play")
    resize(terminal, 40, 10)
    time.sleep(0.3)
    run_on(terminal, 0.5)
    assert "nearest" not in text(terminal, 40, 10)
    terminal.until(lambda: ROBOT.search(text(terminal, 40, 10)), "the robot")
    terminal.send(b"\x03")
    assert terminal.wait() == 0


def test_a_world_with_errors_says_so_and_leaves_the_way_out(kit: Open, tmp_path: Path) -> None:
    world = tmp_path / "world.yaml"
    world.write_text("properties: {}\nlayers: []\nmodles: []\n")
    terminal = kit("play", str(world), ready="world.yaml:3")
    assert "models" in text(terminal)
    terminal.send(b" m")
    terminal.until(lambda: "Maps" in text(terminal), "the list of maps")
    terminal.send(b"maze\r")
    terminal.until(lambda: ROBOT.search(text(terminal)), "the maze")
    terminal.send(b"\x03")
    assert terminal.wait() == 0
