"""``render_mode="human"`` in a real terminal: braille that is painted where it was, at the robot's pace."""

from __future__ import annotations

import fcntl
import os
import struct
import subprocess
import sys
import termios

import pyte

SCRIPT = """
import gymnasium, kit
env = gymnasium.make("RobotKit/Turn-v0", render_mode="human")
env.reset(seed=1)
for _ in range(5):
    env.step(0)
print("done")
"""
COLUMNS, ROWS = 60, 20


def run_in_terminal(script: str) -> tuple[pyte.Screen, bytes]:
    """The screen after a script has ended, and all that it wrote."""
    controller, terminal = os.openpty()
    fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", ROWS, COLUMNS, 0, 0))
    screen = pyte.Screen(COLUMNS, ROWS)
    stream, written = pyte.ByteStream(screen), b""
    with subprocess.Popen(
        [sys.executable, "-c", script],
        stdin=terminal,
        stdout=terminal,
        stderr=terminal,
        env={**os.environ, "PYTHONUTF8": "1", "COLUMNS": "", "LINES": ""},
    ):
        os.close(terminal)
        while True:
            try:
                data = os.read(controller, 65536)
            except OSError:  # Linux says so when the program has ended
                break
            if not data:
                break
            written += data
            stream.feed(data)
    os.close(controller)
    return screen, written


def test_every_step_is_painted_over_the_last_one() -> None:
    screen, written = run_in_terminal(SCRIPT)
    shown = [line.rstrip() for line in screen.display]
    captions = [line for line in shown if "step" in line]
    assert captions == ["turn_a_to_b, step 5 of 200"], "\n".join(shown)
    assert written.count(b"step ") == 6, "each step was painted"
    assert "done" in shown[shown.index(captions[0]) + 1]
    world = "".join(shown[: shown.index(captions[0])])
    assert any("\u2800" < sign <= "\u28ff" for sign in world)
    assert b"\x1b[2J" not in written, "nothing else on the screen is cleared"


def test_in_a_pipe_one_picture_follows_another() -> None:
    done = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=True)
    assert "\x1b" not in done.stdout
    assert [f"step {number} of 200" in done.stdout for number in range(7)] == [True] * 6 + [False]
