"""Kills a scenario's program at random moments, and looks for what is lost or left."""

from __future__ import annotations

import os
import random
import signal
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from tests.kills.scenarios import SCENARIOS, KillScenario, Place

END_S: Final = 60.0
"""How long what a killed program has started may take to end [s]."""
NOTE_S: Final = 0.01
"""How often what is confirmed is noted [s]."""


@dataclass(slots=True)
class KillReport:
    """What came of the kills of one scenario."""

    kills: int = 0
    in_time: int = 0
    """Kills that hit the program before its end."""
    findings: list[str] = field(default_factory=list)


def run_kills(
    name: str,
    kills: int,
    folder: Path,
    *,
    seed: int,
    on_kill: Callable[[KillReport], object] = lambda report: None,
    scenarios: Mapping[str, Callable[[Place], KillScenario]] = SCENARIOS,
) -> KillReport:
    """Kills a scenario's program so many times. ``on_kill`` is called after each."""
    place = Place(folder / name)
    place.make()
    rng = random.Random(f"{seed}/{name}")
    scenario, report = scenarios[name](place), KillReport()
    for number in range(kills):
        moment_s, whole_group = rng.uniform(0.0, scenario.longest_s), rng.random() < 0.5
        has_hit, problems = kill_once(scenario, place, moment_s, whole_group=whole_group)
        report.kills += 1
        report.in_time += has_hit
        how = "with its group " if whole_group else ""
        report.findings += [
            f"{name} {number}, killed {how}after {moment_s:.3f} s: {problem}" for problem in problems
        ]
        on_kill(report)
    return report


def kill_once(
    scenario: KillScenario, place: Place, moment_s: float, *, whole_group: bool
) -> tuple[bool, list[str]]:
    """Starts the program, kills it after so many seconds; returns whether it still ran, and what is wrong afterwards."""
    program = scenario.start()
    until = time.monotonic() + moment_s
    while time.monotonic() < until and program.poll() is None:
        scenario.note_confirmed()
        time.sleep(NOTE_S)
    has_hit = program.poll() is None
    with suppress(ProcessLookupError):
        os.killpg(program.pid, signal.SIGKILL) if whole_group else program.kill()
    program.wait()
    problems = list(_processes_left(place))
    problems += scenario.start_next()
    problems += _processes_left(place)
    problems += place.leftovers()
    problems += scenario.problems()
    return has_hit, problems


def _processes_left(place: Place) -> Iterator[str]:
    """Waits until nothing runs in the place any more; yields what does not end."""
    until = time.monotonic() + END_S
    while (living := list(processes_in(place.folder))) and time.monotonic() < until:
        time.sleep(NOTE_S)
    for process in living:
        command = b""
        with suppress(OSError):
            command = Path(f"/proc/{process}/cmdline").read_bytes()
        words = command.decode(errors="replace").split("\0")
        yield f"a process is left: {' '.join(words)[:200]}"
        with suppress(ProcessLookupError):
            os.kill(process, signal.SIGKILL)


def processes_in(folder: Path) -> Iterator[int]:
    """Yields the living processes that work in a folder, or were started with its path."""
    mark = os.fsencode(folder) + b"/"
    for entry in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):  # over, or another user's
            state = (entry / "stat").read_bytes().rpartition(b")")[2].split()[0]
            if state in (b"Z", b"X"):
                continue
            started_with = (entry / "environ").read_bytes() + (entry / "cmdline").read_bytes()
            if mark in started_with or (entry / "cwd").resolve().is_relative_to(folder):
                yield int(entry.name)
