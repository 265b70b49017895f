"""A few kills of every scenario, and the search for what is left: it finds what it is there to find.

``python -m tests.kills`` kills as often as wanted.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from kit.host.private_folder import PREFIX
from kit.inspection.sockets import listen
from tests.kills.run import kill_once, processes_in, run_kills
from tests.kills.scenarios import SCENARIOS, Place

pytestmark = pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="processes are read in /proc")

KILLS = 4


@pytest.mark.daily(3)
@pytest.mark.long
@pytest.mark.timeout(900)
@pytest.mark.parametrize("name", SCENARIOS)
def test_a_killed_program_loses_nothing_and_leaves_nothing(name: str, tmp_path: Path) -> None:
    report = run_kills(name, KILLS, tmp_path, seed=2026)
    assert report.findings == []
    assert report.kills == KILLS
    assert report.in_time > 0, "one of the kills came in the middle"


class Careless:
    """Leaves a folder and a socket, and has confirmed what it does not keep."""

    longest_s = 60.0

    def __init__(self, place: Place) -> None:
        self._place = place

    def start(self) -> subprocess.Popen[bytes]:
        (self._place.temporary / f"{PREFIX}00000000-1-1-x").mkdir()
        listener, _ = listen(self._place.workspace, "world")
        listener.close()
        return self._place.start("-c", "import time; time.sleep(600)")

    def note_confirmed(self) -> None:
        assert list(processes_in(self._place.folder))

    def start_next(self) -> Iterator[str]:
        yield "the next start failed"

    def problems(self) -> Iterator[str]:
        yield "an answer is lost"


def test_what_is_left_or_lost_is_found(tmp_path: Path) -> None:
    place = Place(tmp_path / "p")
    place.make()
    has_hit, problems = kill_once(Careless(place), place, 0.05, whole_group=False)
    assert has_hit
    told = "\n".join(problems)
    for said in ("next start failed", "a private folder is left", "a socket is left", "an answer is lost"):
        assert said in told


def test_a_process_that_is_left_is_found_and_ended(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tests.kills.run.END_S", 0.1)
    place = Place(tmp_path / "p")
    place.make()
    code = "import subprocess, sys, time; subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(600)']); time.sleep(600)"

    class Forks(Careless):
        def start(self) -> subprocess.Popen[bytes]:
            program = self._place.start("-c", code)
            while len(list(processes_in(self._place.folder))) < 2:
                assert program.poll() is None
            return program

    _, problems = kill_once(Forks(place), place, 0.0, whole_group=False)
    assert any("a process is left" in problem and sys.executable in problem for problem in problems)
    assert list(processes_in(place.folder)) == []
