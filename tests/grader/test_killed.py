"""A grading or a launch that is killed with SIGKILL leaves no folder and no process behind after the next start."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from kit.host.private_folder import PREFIX
from kit.host.sandbox.reaper import descendants
from tests.grader.conftest import FORWARD, QUICK, write_assignment

PATIENCE_S = 120.0
SPINS = FORWARD.replace("    def go(self):\n", "    def go(self):\n        while True: pass\n")
LAUNCH = Path(__file__).parents[2] / "lessons" / "04-launch-files" / "driver"
SLOW_LAUNCH = "def generate_launch_description():\n    while True: pass\n"
NEXT_START = "from kit.host.private_folder import private_folder\nwith private_folder():\n    pass\n"


def _wait(is_met: Callable[[], bool]) -> None:
    deadline = time.monotonic() + PATIENCE_S
    while not is_met():
        assert time.monotonic() < deadline, "it never came to that"
        time.sleep(0.02)


def _is_alive(process: int) -> bool:
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] not in ("Z", "X")
    except OSError:
        return False


def _folders(temporary: Path) -> list[Path]:
    return list(temporary.glob(f"{PREFIX}*"))


@pytest.mark.long
@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="processes are counted in /proc")
@pytest.mark.parametrize("kind", ["controller", "launch"])
def test_a_killed_grading_is_cleaned_up_by_the_next_start(kind: str, tmp_path: Path) -> None:
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    sheet = (
        write_assignment(tmp_path / "sheet", QUICK + "budget: {reply: 60}\n")
        if kind == "controller"
        else LAUNCH
    )
    work = tmp_path / ("controller.py" if kind == "controller" else "driver.launch.py")
    work.write_text(SPINS if kind == "controller" else SLOW_LAUNCH)
    environment = {**os.environ, "TMPDIR": str(temporary), "PYTHONPATH": os.pathsep.join(sys.path)}
    grading = subprocess.Popen(
        [
            sys.executable,
            "-P",
            "-m",
            "grader",
            "check",
            str(work),
            "--assignment",
            str(sheet),
            "--level",
            "0",
        ],
        env=environment,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        _wait(lambda: len(_folders(temporary)) > 1 and len(descendants(grading.pid)) > 1)
        started = descendants(grading.pid)
    finally:
        os.kill(grading.pid, signal.SIGKILL)
        grading.wait()
    assert all(folder.stat().st_mode & 0o777 == 0o700 for folder in _folders(temporary))
    _wait(lambda: not any(map(_is_alive, started)))
    subprocess.run([sys.executable, "-P", "-c", NEXT_START], env=environment, check=True)
    assert _folders(temporary) == []
