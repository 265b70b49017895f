"""From the README's first line to a robot that moves: seconds and megabytes, from nothing.

Run as ``python tests/benchmarks/first_start.py [learn|core|wheel]``: by the README's own line in a new clone; the same
without torch; or from a built wheel by ``uvx``. Home, pip's cache and uv's cache are new and empty, the terminal is 80x24.
What a setting of this machine says (an index, a folder with a wheel of torch: ``PIP_FIND_LINKS``) holds here too.
"""

from __future__ import annotations

import fcntl
import os
import pty
import re
import select
import subprocess
import sys
import termios
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import pyte

ROOT = Path(__file__).resolve().parents[2]
README = (ROOT / "README.md").read_text()
COLUMNS, ROWS = 80, 24
PATIENCE_S = 1200.0
BRAILLE = re.compile("[\u2801-\u28ff]")
"""Cells of the moving picture in which a ray, a trace or a robot stands."""


def line_of(way: str, folder: Path) -> str:
    """What is typed, in a clone of this repository or, for a wheel, beside it."""
    found = re.search(r"^python3 -m venv .*$", README.partition("## Start")[2], re.M)
    assert found is not None
    if way == "wheel":
        build = [sys.executable, "-m", "pip", "wheel", "-q", "--no-deps", "-w", str(folder), str(ROOT)]
        subprocess.run(build, check=True)
        return f"uvx --from {next(folder.glob('*.whl'))} robot-learning-kit"
    clone = folder / "clone"
    subprocess.run(["git", "clone", "-q", str(ROOT), str(clone)], check=True)
    line = found[0] if way == "learn" else found[0].replace("-e '.[learn]'", "-e .")
    return f"cd {clone} && {line}"


def seconds_to_motion(line: str, home: Path) -> float:
    """Types a line into a new shell; until the menu's robot has been seen in three places."""
    mine, theirs = pty.openpty()
    fcntl.ioctl(
        theirs,
        termios.TIOCSWINSZ,
        ROWS.to_bytes(2, sys.byteorder) + COLUMNS.to_bytes(2, sys.byteorder) + bytes(4),
    )
    kept = ("PATH", "LANG", "SSL_CERT_FILE")
    environment = {
        name: value for name, value in os.environ.items() if name in kept or name.startswith(("PIP_", "UV_"))
    }
    screen = pyte.Screen(COLUMNS, ROWS)
    stream = pyte.ByteStream(screen)
    seen: set[str] = set()
    start = time.perf_counter()
    process = subprocess.Popen(
        ["bash", "-c", line],
        stdin=theirs,
        stdout=theirs,
        stderr=theirs,
        cwd=home,
        env={**environment, "HOME": str(home), "TERM": "xterm-256color"},
        start_new_session=True,
    )
    try:
        while len(seen) < 3:
            if process.poll() is not None or time.perf_counter() - start > PATIENCE_S:
                raise SystemExit("\n".join(["It did not come to that:", *screen.display]))
            if select.select([mine], [], [], 0.2)[0]:
                stream.feed(os.read(mine, 65536))
                if any("WASD" in row for row in screen.display):
                    seen.add("".join(BRAILLE.findall("".join(screen.display))))
        return time.perf_counter() - start
    finally:
        os.write(mine, b"\x03")
        try:
            process.wait(20)
        except subprocess.TimeoutExpired:
            process.kill()
        os.close(mine)
        os.close(theirs)


def megabytes(*folders: Path) -> float:
    files = (
        file for folder in folders for file in folder.rglob("*") if file.is_file() and not file.is_symlink()
    )
    return sum(file.stat().st_size for file in files) / 1e6


def main(ways: list[str]) -> None:
    for way in ways or ["core", "learn", "wheel"]:
        with TemporaryDirectory() as made:
            folder, home = Path(made), Path(made, "home")
            home.mkdir()
            taken = seconds_to_motion(line_of(way, folder), home)
            installed = [folder / "clone" / ".venv"] if way != "wheel" else []
            print(
                f"{way:<6} {taken:6.1f} s to a moving robot   {megabytes(home):7.0f} MB in the home, caches among them   "
                f"{megabytes(*installed):7.0f} MB installed",
                flush=True,
            )


if __name__ == "__main__":
    main(sys.argv[1:])
