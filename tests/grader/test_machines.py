"""A few attacks of the catalogue as root, as an ordinary user and without Landlock; ``python -m tests.grader.machines``
tries all of them."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.grader.conftest import LOCKS
from tests.grader.machines import ABSENT, FAILED, MACHINES, ROOT, SKIPPED, try_attacks, unheld

pytestmark = [
    pytest.mark.long,
    pytest.mark.timeout(600),
    LOCKS,
    pytest.mark.skipif(sys.platform != "linux", reason="needs Linux"),
]

WORDS = ("read the assignment", "fork bomb")


@pytest.mark.parametrize("machine", MACHINES)
def test_what_is_held_is_held_on_every_machine(machine: str) -> None:
    lines = list(try_attacks(machine, WORDS))
    skipped = [line for line in lines if line.startswith(SKIPPED)]
    if skipped:
        pytest.skip(skipped[0])
    assert unheld(lines) == []
    rows = [line.split() for line in lines if line.strip()[:2].strip().isdigit()]
    assert len(rows) >= len(WORDS)
    assert not [row for row in rows if "NOT" in row]
    levels = {line.split(":")[0] for line in lines if line.startswith("level ")}
    levels = {level for level in levels if not level.endswith(ABSENT)}
    expected = {
        "root": {"level 0", "level 1"},
        "user": {"level 0", "level 1"},
        "no-landlock": {"level 0"},
    }[machine]
    assert expected <= levels
    if machine == "no-landlock":
        assert levels == expected, "without Landlock there is no level above 0, and none is pretended"
    assert any(line.startswith(f"user {0 if machine == 'root' else ''}".rstrip()) for line in lines)


def test_what_is_not_held_is_found() -> None:
    lines = [
        "  1  read  controller  1  fail  8  NOT HELD (fail)  works",
        f"{FAILED} with exit code 1",
        "held",
    ]
    assert unheld(lines) == lines[:2]


WITHOUT_LANDLOCK = """
import os, sys
from tests.grader.machines import become_without_landlock
become_without_landlock()
os.execv(sys.executable, [sys.executable, "-P", "-m", "grader", *sys.argv[1:]])
"""
CIRCLE = ROOT / "lessons" / "09-your-own-controller" / "circle"


@pytest.mark.parametrize(
    ("words", "level"),
    [
        (["check", "{work}"], 1),
        (["check", "{work}", "--secret"], 1),
        (["check", "{work}", "--level", "2"], 2),
        (["cohort", "{folder}", "--queue", "{folder}-queue", "--secret"], 1),
    ],
)
def test_a_kernel_that_refuses_landlock_gives_no_grade_and_says_why(
    words: list[str], level: int, tmp_path: Path
) -> None:
    folder = tmp_path / "in"
    folder.mkdir()
    work = Path(shutil.copy(CIRCLE / "starter.py", folder / "ada.py"))
    given = [word.format(work=work, folder=folder) for word in words]
    done = subprocess.run(
        [sys.executable, "-c", WITHOUT_LANDLOCK, *given, "--assignment", str(CIRCLE)],
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2
    assert f"does not reach confinement level {level}" in done.stderr
    assert "Traceback" not in done.stderr
    assert "points" not in done.stdout
