"""From a key to the picture over SSH: ``python tests/benchmarks/key_to_picture.py``.

The kit runs behind a real sshd on this machine, on the other side of a link of 30 KB/s and 20 ms each way. A turn key is
pressed and released at odd moments; measured is the time from the press until the screen shows another heading, as a terminal
that understands the bytes would, in 16 colours and in a theme's true ones. Needs OpenSSH's server and client.
"""

from __future__ import annotations

import random
import re
import sys
import tempfile
import time
from pathlib import Path
from statistics import median, quantiles

sys.path.insert(0, str(Path(__file__).parents[2]))

from tests.ssh.connection import SSH, SSHD, open_kit, private_sshd
from tests.tui.test_play_pty import User, resize
from tests.tui.widgets.test_world_view_pty import run_on

RATE, DELAY = 30_000.0, 0.020
"""Of the link [bytes/s, s]."""
SIZES = ((80, 24), (200, 50))
COLOURS = {"16 colours": "16", "theme": "true"}
"""What the kit is told of the terminal's colours, by the name of the line that is printed."""
PRESSES = 30
PRESS, RELEASE = (f"\x1b[1;1:{kind}D".encode() for kind in (1, 3))
"""The left arrow, as terminals that tell presses from releases send it."""
HEADING = re.compile(r"heading +(-?[0-9.]+)")


def heading(user: User) -> str:
    """What the screen says of the robot's heading."""
    found = HEADING.search(user.text)
    return found[1] if found else ""


def reactions(user: User) -> list[float]:
    """Seconds from each press to the first screen with another heading."""
    chance = random.Random(1)
    times = []
    for _ in range(PRESSES):
        before = heading(user)
        start = time.perf_counter()
        user.send(PRESS)
        while heading(user) == before:
            user.pump(0.002)
        times.append(time.perf_counter() - start)
        user.send(RELEASE)
        run_on(user, 0.5 + chance.random() / 10)
    return times


def measured(server: tuple[int, Path], folder: Path, size: tuple[int, int], colour: str) -> list[float]:
    """The reactions of a kit with these colours on a screen of this size."""
    program = ("drive", "simple", "--controller", "teleop")
    user = open_kit(server, folder, RATE, DELAY, *program, variables=[f"KIT_COLOR={colour}"])
    try:
        user.until(lambda: "exact" in user.text, "the terminal's answer", limit=60)
        if size != SIZES[0]:  # in which it was opened
            resize(user, *size)
        user.until(lambda: bool(heading(user)), "the heading", limit=60)
        run_on(user, 3.0)
        return reactions(user)
    finally:
        user.close()


def main() -> None:
    if not SSHD or not SSH:
        raise SystemExit("OpenSSH's server and client are not installed: apt-get install openssh-server")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        with private_sshd(folder) as server:
            for columns, rows in SIZES:
                for told, colour in COLOURS.items():
                    times = measured(server, folder, (columns, rows), colour)
                    shown = f"median {median(times) * 1000:.0f} ms, nine of ten within {quantiles(times, n=10)[-1] * 1000:.0f} ms"
                    print(f"{columns}x{rows}, {told}, 30 KB/s, 20 ms each way, key to picture: {shown}")


if __name__ == "__main__":
    main()
