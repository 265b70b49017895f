"""From the command to the picture: seconds until the kit's frame and its world are on the screen, and to leave it.

Run as ``python tests/benchmarks/first_frame.py``. Each figure is the median of several starts in a terminal of
80x24, beside the time of a bare interpreter that imports Textual's app, and as a ratio to it.
"""

from __future__ import annotations

import re
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import kit

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from tests.tui.test_play_pty import ROBOT, User  # noqa: E402 - found beside this file's folder

STARTS = 5
PATIENCE = 120.0
"""Seconds; the very first start compiles the kernels."""
MAIN = str(Path(kit.__file__).with_name("__main__.py"))


def seconds(action: Callable[[], object]) -> float:
    start = time.perf_counter()
    action()
    return time.perf_counter() - start


def baseline() -> float:
    command = [sys.executable, "-c", "import textual.app"]
    return statistics.median(seconds(lambda: subprocess.run(command, check=True)) for _ in range(STARTS))


def one_start(*words: str) -> tuple[float, float, float]:
    """Until the frame, until the robot in its maze, and from Ctrl-C to the end."""
    start = time.perf_counter()
    user = User(MAIN, *words)
    try:
        user.until(lambda: b"drive" in user.output, "the frame", PATIENCE)
        frame = time.perf_counter() - start
        user.until(lambda: ROBOT.search(user.output.decode(errors="ignore")), "the robot", PATIENCE)
        robot = time.perf_counter() - start
        left = time.perf_counter()
        user.send(b"\x03")
        user.wait()
        return frame, robot, time.perf_counter() - left
    finally:
        user.close()


def main() -> None:
    one_start()  # the kernels are compiled once for all
    bare = baseline()
    print(f"bare `import textual.app`           {bare:.2f} s")
    names = ("frame", "robot in its maze", "left after Ctrl-C")
    for words in ((), ("drive",)):
        figures = zip(*(one_start(*words) for _ in range(STARTS)), strict=True)
        for name, times in zip(names, figures, strict=True):
            middle = statistics.median(times)
            title = f"{' '.join(('kit', *words))}: {name}"
            print(f"{title:<35} {middle:.2f} s   {middle / bare:.1f} times the bare import")
    learned = subprocess.run(
        [sys.executable, "-c", "import sys, kit.tui.screens.start; print('torch' in sys.modules)"],
        capture_output=True,
        text=True,
        check=True,
    )
    print(f"torch imported by then              {re.sub(r'False', 'no', learned.stdout.strip())}")


if __name__ == "__main__":
    main()
