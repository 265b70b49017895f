"""The real verbs, killed at random moments: what they had confirmed is in the journal, and an export is whole or not
there. Beside `test_progress.py`, which kills the journal alone."""

from __future__ import annotations

import random
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pytest

from kit.school.progress import EventKind, ProgressEvent, ProgressJournal
from kit.school.progress_export import read_export

KILLS = 20
ENTRIES = 20_000
"""So many that an export takes long enough to be hit."""


class Case(NamedTuple):
    """A verb, what it is told, and what its output confirms."""

    words: tuple[str, ...]
    lines: str
    confirmed: Callable[[str], int]
    kept: Callable[[list[ProgressEvent]], int]
    """How many of such things the journal holds."""


def _steps(said: str) -> int:
    """Steps that are completed when this output is seen: one less than the number of the last step shown."""
    return max((int(number) for number in re.findall(r"^Step (\d+) of", said, re.M)), default=1) - 1


def _answers(said: str) -> int:
    return max((int(number) for number in re.findall(r"question (\d+) of", said)), default=1) - 1


CASES = {
    "lesson": Case(
        ("lesson", "1", "--plain"),
        "2\nn\nn\nn\n",
        _steps,
        lambda events: sum(each.kind is EventKind.STEP for each in events),
    ),
    "quiz": Case(
        ("quiz", "--plain"),
        "1\n3\n" * 12,
        _answers,
        lambda events: len({each.subject for each in events if each.kind is EventKind.ANSWER}),
    ),
    "export": Case(("progress", "export", "{file}"), "", lambda said: 0, len),
}


@pytest.mark.daily(3)
@pytest.mark.long
@pytest.mark.parametrize("name", CASES)
def test_a_killed_verb_has_kept_what_it_confirmed(name: str, tmp_path: Path) -> None:
    case, chance = CASES[name], random.Random(8)
    whole = max(_run(case, tmp_path / f"whole{number}", None)[1] for number in range(2))
    partly = 0
    for number in range(KILLS):
        folder = tmp_path / f"{number}"
        # Some moments lie behind the end, where the machine is no slower than before.
        said, _ = _run(case, folder, whole * chance.uniform(0.3, 1.3))
        with ProgressJournal(folder) as progress:
            assert progress.notice == ""
            events = progress.events()
        assert case.kept(events) >= case.confirmed(said)
        partly += case.confirmed(said) > 0
        exported = folder / "export.json"
        if exported.exists():
            assert len(read_export(exported)) == ENTRIES
    assert partly or name == "export"


def _run(case: Case, folder: Path, moment: float | None) -> tuple[str, float]:
    """What it said until it was killed, and how long it ran."""
    folder.mkdir()
    if case.words[-1] == "{file}":
        with ProgressJournal(folder) as progress:
            progress.import_events(
                ProgressEvent(
                    f"{number}", "2026-01-01T00:00:00.000000+00:00", EventKind.STEP, f"01-drive/{number}", {}
                )
                for number in range(ENTRIES)
            )
    words = [word.format(file=folder / "export.json") for word in case.words]
    command = [sys.executable, "-m", "kit", *words]
    began = time.monotonic()
    with (folder / "said.txt").open("w") as out:
        process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=out,
            text=True,
            env={
                "KIT_WORKSPACE": str(folder),
                "PATH": "/usr/bin:/bin",
                "HOME": str(folder),
                "LANG": "C.UTF-8",
            },
        )
        assert process.stdin is not None
        try:
            process.stdin.write(case.lines)
            process.stdin.close()
            process.wait(moment)
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGKILL)
        process.wait(120)
    return (folder / "said.txt").read_text(), time.monotonic() - began
