"""turtlesim as a user runs it: its window in one terminal, its own and tutorials' programs in another."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from kit.inspection.sockets import running_worlds, sockets_folder
from tests.cli.test_program_terminal_pty import KIT, shown
from tests.launch.conftest import kit
from tests.tui.input.conftest import Terminal
from tests.tui.test_play_pty import User
from tests.waiting import wait_until

PROGRAMS = Path(__file__).parent / "programs"


@pytest.fixture
def window(tmp_path: Path) -> Iterator[User]:
    """``kit ros run turtlesim turtlesim_node`` in a terminal."""
    user = User(KIT, "ros", "run", "turtlesim", "turtlesim_node")
    try:
        user.until(lambda: running_worlds(sockets_folder(tmp_path / "workspace")), "the world")
        yield user
    finally:
        user.close()


@pytest.mark.long
def test_keys_in_one_terminal_draw_in_the_other(window: User) -> None:
    keys = Terminal(KIT, "ros", "run", "turtlesim", "turtle_teleop_key")
    try:
        shown(keys, "'Q' to quit.")
        window.until(lambda: "turtlesim" in window.text, "the screen")
        before = _dots(window.text)
        for _ in range(3):
            keys.send(b"\x1b[A")
            keys.pump(0.5)
            window.pump(0.1)
        keys.send(b"r")
        window.until(lambda: _dots(window.text) > before + 5, lambda: f"a line in\n{window.text}")  # type: ignore[arg-type]  # a text that is made only on failure
        window.until(lambda: "Rotation goal completed" in window.text, "the rotation's end")
        keys.send(b"q")
        assert keys.wait() == 0
        keys.assert_sane()
    finally:
        keys.close()
    window.send(b"\x03")
    assert window.wait() in (0, 130)


def _dots(text: str) -> int:
    """How many characters of the picture hold dots."""
    return sum("\u2801" <= character <= "\u28ff" for character in text)


@pytest.mark.long
@pytest.mark.parametrize(
    ("program", "words", "typed", "wanted"),
    [
        ("go_to_goal.py", (), "8\n2.5\n", ("reached 8", "2.")),
        ("catch_them_all.py", ("--ros-args", "-p", "turtles:=2"), "", ("caught turtle2 turtle3",)),
        ("follow.py", (), "", ("follows",)),
    ],
)
def test_tutorials_programs_run(
    program: str, words: tuple[str, ...], typed: str, wanted: tuple[str, ...], tmp_path: Path
) -> None:
    with kit(tmp_path / "workspace", "ros", "run", "turtlesim", "turtlesim_node"):
        wait_until(lambda: running_worlds(sockets_folder(tmp_path / "workspace")))
        done = subprocess.run(
            [sys.executable, KIT, "ros", "run", str(PROGRAMS / program), *words],
            input=typed,
            capture_output=True,
            text=True,
            timeout=100,
            check=False,
        )
    assert done.returncode == 0, done.stdout + done.stderr
    for text in wanted:
        assert text in done.stdout


@pytest.mark.long
def test_a_square_is_drawn_and_another_turtle_mimics_it(tmp_path: Path) -> None:
    workspace = tmp_path / "workspace"
    with kit(workspace, "ros", "run", "turtlesim", "turtlesim_node"):
        wait_until(lambda: running_worlds(sockets_folder(workspace)))
        with kit(workspace, "ros", "run", "turtlesim", "draw_square"):
            remaps = ("-r", "input/pose:=turtle1/pose", "-r", "output/cmd_vel:=turtle1/mimicked")
            with (
                kit(workspace, "ros", "run", "turtlesim", "mimic", "--ros-args", *remaps),
                kit(
                    workspace,
                    "ros",
                    "topic",
                    "echo",
                    "--once",
                    "/turtle1/mimicked",
                    "geometry_msgs/msg/Twist",
                ) as echo,
            ):
                said, _ = echo.communicate(timeout=60)
            assert "linear:" in said
            with kit(workspace, "ros", "topic", "echo", "/turtle1/pose") as echo:
                assert echo.stdout is not None
                for line in echo.stdout:
                    if line.startswith("theta:") and abs(float(line.split()[1])) > 1.0:
                        break  # it has turned its first corner
