"""A launch file carried out on the screen, in a real terminal; and a second terminal that looks in."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from kit.inspection.sockets import running_worlds, sockets_folder
from tests.launch.conftest import TWO_ROBOTS
from tests.run.test_connection_watch import DEAF, LAUNCH, WORLD, tells_of_both
from tests.tui.test_play_pty import Open, kit

__all__ = ["kit"]


def second_terminal(*words: str) -> str:
    done = subprocess.run(
        [sys.executable, "-m", "kit", "ros", *words], capture_output=True, text=True, check=False, timeout=30
    )
    return done.stdout + done.stderr


@pytest.fixture
def workspace() -> Path:
    return Path(os.environ["KIT_WORKSPACE"])


def test_a_launch_is_watched_looked_into_and_left(kit: Open, workspace: Path) -> None:
    terminal = kit("launch", str(TWO_ROBOTS), "update_rate:=200.0")
    terminal.until(lambda: "ready to drive" in terminal.text, "what the program says")
    terminal.until(lambda: "two_robots" in terminal.text, "two_robots")
    terminal.until(lambda: "speed x2" in terminal.text, "the speed that the launch file asks for")
    assert "/pair" in second_terminal("node", "list").splitlines()
    assert second_terminal("param", "get", "pair", "speed") == "Double value is: 0.4\n"
    terminal.send(b"p")
    terminal.until(lambda: "paused" in terminal.text, "the pause")
    assert second_terminal("topic", "type", "/left/odom") == "nav_msgs/msg/Odometry\n"
    terminal.send(b"n")
    terminal.until(lambda: "/flatland_server" in terminal.text and "/pair" in terminal.text, "the nodes")
    terminal.send(b"\x03")
    assert terminal.wait() == 0
    terminal.assert_sane()
    assert running_worlds(sockets_folder(workspace)) == []


def test_a_launched_program_that_hears_nothing_is_told_of(kit: Open, tmp_path: Path) -> None:
    (tmp_path / "deaf.py").write_text(DEAF)
    launch = tmp_path / "deaf.launch.py"
    launch.write_text(LAUNCH.format(world=str(WORLD), program=str(tmp_path / "deaf.py")))
    terminal = kit("launch", str(launch))
    terminal.until(lambda: tells_of_both(terminal.text), "what it says and what there is")
    terminal.send(b"\x03")
    assert terminal.wait() == 0


def test_the_play_screen_has_a_door_that_moves_with_the_map(kit: Open, workspace: Path) -> None:
    terminal = kit("drive", "maze")
    (world,) = running_worlds(sockets_folder(workspace))
    assert world.name.startswith("maze-")
    terminal.until(
        lambda: "/random_walk" in second_terminal("node", "list").splitlines(), "the controller's node"
    )
    terminal.send(b"\x03")
    assert terminal.wait() == 0
    assert running_worlds(sockets_folder(workspace)) == []


@pytest.mark.parametrize(
    ("arguments", "message"),
    [(("learn:=perhaps",), "Valid options are"), (("world_path:=/nowhere.yaml",), "/nowhere.yaml")],
)
def test_what_cannot_be_launched_leaves_the_screen_and_says_why(
    arguments: tuple[str, ...], message: str, kit: Open
) -> None:
    terminal = kit("launch", str(TWO_ROBOTS), *arguments, ready=message)
    assert terminal.wait() == 2
    terminal.assert_sane()
