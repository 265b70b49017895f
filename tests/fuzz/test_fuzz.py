"""A few inputs of every fuzz target, and the runner itself: it finds what it is there to find.

``python -m tests.fuzz`` tries as many as wanted.
"""

from __future__ import annotations

import os
import random
import subprocess
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import ClassVar

import pytest

from tests.fuzz.run import TARGETS, BatchReport, FuzzTarget, run_batch

pytestmark = pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="growth is read in /proc")

INPUTS = 500
SEED = 2026


@pytest.mark.long
@pytest.mark.timeout(600)
@pytest.mark.parametrize("name", TARGETS)
def test_whatever_comes_is_read_or_refused(name: str) -> None:
    report = run_batch(name, range(INPUTS), seed=SEED)
    assert [str(finding) for finding in report.findings] == []
    assert report.done == sum(report.outcomes.values()) == INPUTS
    assert len(report.outcomes) > 1, "some are read, some are refused"


class Planted:
    """A target with a fault."""

    kept: ClassVar[list[object]] = []

    def __init__(self, attempt: Callable[[random.Random], object]) -> None:
        self._attempt = attempt

    def attempt(self, rng: random.Random) -> str:
        return str(self._attempt(rng))


def tried(attempt: Callable[[random.Random], object], *, hang_s: float = 60.0) -> BatchReport:
    """Runs ten inputs of a planted target."""

    def make(folder: Path) -> FuzzTarget:
        return Planted(attempt)

    return run_batch("planted", range(100, 110), seed=1, targets={"planted": make}, hang_s=hang_s)


def test_what_is_sound_has_no_findings() -> None:
    report = tried(lambda rng: "read" if rng.random() < 2 else "refused")
    assert (report.findings, report.done, dict(report.outcomes)) == ([], 10, {"read": 10})


@pytest.mark.long
def test_the_same_seed_makes_the_same_inputs() -> None:
    first, second = (tried(lambda rng: rng.random()).outcomes for _ in range(2))
    assert first == second
    assert len(first) == 10


FAULTS: dict[str, tuple[Callable[[random.Random], object], str]] = {
    "traceback": (lambda rng: 1 // 0, "ZeroDivisionError"),
    "crash": (lambda rng: os._exit(7), "status 7"),
    "descriptors": (lambda rng: os.open(os.devnull, os.O_RDONLY), "descriptors left open"),
    "files": (lambda rng: tempfile.mkdtemp(), "temporary files left"),
    "memory": (lambda rng: Planted.kept.append(b"x" * (16 << 20)), "memory grew by"),
    "processes": (lambda rng: Planted.kept.append(subprocess.Popen(["sleep", "600"])), "processes left"),
}


@pytest.mark.sampled(6)
@pytest.mark.parametrize("fault", FAULTS)
def test_each_fault_is_found(fault: str) -> None:
    attempt, said = FAULTS[fault]
    findings = tried(attempt).findings
    assert findings
    assert all(said in finding.problem for finding in findings), findings
    assert all(100 <= finding.number < 110 for finding in findings)


def test_a_target_that_cannot_be_prepared_ends_the_run() -> None:
    def make(folder: Path) -> FuzzTarget:
        raise OSError("no room")

    with pytest.raises(RuntimeError, match="planted could not be prepared"):
        run_batch("planted", range(3), seed=1, targets={"planted": make})


def test_a_hang_is_ended() -> None:
    def spin(rng: random.Random) -> None:
        while True:
            pass

    report = tried(spin, hang_s=0.5)
    assert [(finding.number, report.done) for finding in report.findings] == [(100, 1)]
    assert "no answer" in report.findings[0].problem
