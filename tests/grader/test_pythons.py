"""The same points wherever a class is graded: on every level of confinement, by every Python, one by one and at once."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from kit.host.sandbox.confinement import Level
from kit.host.sandbox.probe import probe_levels
from tests.grader.conftest import LOCKS, TEMPLATES

ROOT = Path(__file__).parents[2]
NEEDED = ["numba", "numpy", "pymunk", "yaml", "click", "PIL", "networkx", "platformdirs"]

SAYS = f"import sys, {', '.join(NEEDED)}; print('%d.%d' % sys.version_info[:2])"


def pythons() -> dict[str, str]:
    """By version: this one; those that ``KIT_OTHER_PYTHONS`` names, which ``.ci/other-pythons`` sets; and those on the
    path and of pyenv that happen to have what the grader needs."""
    found = {f"{sys.version_info.major}.{sys.version_info.minor}": sys.executable}
    named = os.environ.get("KIT_OTHER_PYTHONS", "").split(os.pathsep)
    around = [shutil.which(f"python3.{minor}") or "" for minor in (11, 12, 13)]
    of_pyenv = sorted(map(str, Path.home().glob(".pyenv/versions/3.1[1-3]*/bin/python")))
    for python in filter(None, (*named, *around, *of_pyenv)):
        try:
            said = subprocess.run([python, "-P", "-c", SAYS], capture_output=True, text=True, timeout=60)
        except (OSError, subprocess.TimeoutExpired):
            continue
        if said.returncode == 0 and re.fullmatch(r"3\.1[1-3]", said.stdout.strip()):
            found.setdefault(said.stdout.strip(), python)
    return found


def handed_in(folder: Path) -> Path:
    """The template's own solution, starter and wrong solutions, as a class."""
    folder.mkdir()
    template = TEMPLATES / "controller"
    for file in (template / "starter.py", template / "solution.py", *(template / "wrong").glob("*.py")):
        shutil.copy(file, folder / file.name)
    return folder


def graded(python: str, folder: Path, queue: Path, *, level: Level, jobs: int) -> dict[str, Any]:
    """What each test earned and how it ended, by submission."""
    done = subprocess.run(
        [
            *(python, "-P", "-m", "grader", "cohort", str(folder), "--level", str(int(level))),
            *("--jobs", str(jobs), "--assignment", str(TEMPLATES / "controller"), "--queue", str(queue)),
        ],
        env=os.environ | {"PYTHONPATH": str(ROOT), "PYTHONDONTWRITEBYTECODE": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    table = json.loads((queue / "gradebook.json").read_bytes())
    return {row["name"]: (row["points"], row["tests"], row["statuses"]) for row in table}


@pytest.mark.long
@pytest.mark.timeout(1800)
@LOCKS
def test_levels_pythons_and_jobs_do_not_change_points(tmp_path: Path) -> None:
    levels = [
        support.level
        for support in probe_levels()
        if support.is_available and support.level <= Level.SEPARATE
    ]
    assert len(levels) >= 2
    found = pythons()
    folder = handed_in(tmp_path / "in")
    ways = [(level, 2) for level in levels] + [(Level.FILTERED, 1)]
    tables = {
        (version, int(level), jobs): graded(
            python, folder, tmp_path / f"{version}-{int(level)}-{jobs}", level=level, jobs=jobs
        )
        for version, python in found.items()
        for level, jobs in ways
    }
    first = next(iter(tables.values()))
    assert len({points for points, _, _ in first.values()}) >= 4, "good, middling and bad ones"
    assert {which: table for which, table in tables.items() if table != first} == {}
    if len(found) == 1:
        pytest.skip(
            f"only Python {next(iter(found))} is here with what the grader needs; levels and jobs agree"
        )
