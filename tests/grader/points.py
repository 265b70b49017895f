"""Grades the works to the lessons' exercises in every way in which a class is graded, and compares the points.

``python -m tests.grader.points`` goes through all works at all levels, with all Pythons, serial and parallel, in a checkout
and installed from a wheel; it may be stopped at any moment, and the same command goes on. ``--sample`` takes thirty works.
Exit code 1 if any points differ.
"""

from __future__ import annotations

import itertools
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final, TypeAlias

import click

from grader.self_test import written_out
from kit.host.sandbox.probe import probe_levels
from kit.host.sandbox.sandbox_config import Level
from kit.workspace import write_atomically
from tests.test_wheel import build_wheel, install_wheel

ROOT: Final = Path(__file__).parents[2]
IGNORED: Final = ("__pycache__", ".DS_Store")
SAMPLE: Final = (
    "02-nodes-and-topics/heartbeat",
    "04-launch-files/driver",
    "05-world-files/to-scale",
    "08-fewest-layers/warehouse",
    "10-words-of-learning/sectors",
    "10-words-of-learning/words",
)
"""Exercises of six kinds of work, none of which takes long."""
SAMPLE_WORKS: Final = 5
"""Of each of them."""
NEEDED: Final = ("numba", "numpy", "pymunk", "yaml", "click", "PIL", "networkx", "platformdirs")
SAYS: Final = f"import sys, {', '.join(NEEDED)}; print('%d.%d' % sys.version_info[:2])"

Points: TypeAlias = dict[str, list[Any]]
"""By work: its points, the points of each criterion, the status of each criterion."""

PROGRAM: Final = Path(__file__).with_name("class_points.py")
"""What ``grader cohort`` does, for one exercise after the other."""


@dataclass(frozen=True, slots=True)
class Setting:
    """One way of grading a class."""

    level: Level
    python: str
    """Version, such as ``3.11``."""
    jobs: int
    installed: str
    """``checkout`` or ``wheel``."""

    def __str__(self) -> str:
        jobs = "serial" if self.jobs == 1 else "parallel"
        return f"level {int(self.level)}, Python {self.python}, {jobs}, {self.installed}"


def reference_setting() -> Setting:
    """The setting that all others are compared with: level 1, this Python, parallel, the checkout."""
    return Setting(Level.FILTERED, this_version(), 2, "checkout")


def all_settings(pythons: Iterable[str]) -> list[Setting]:
    """Returns every setting that this machine has, with the reference first."""
    levels = [support.level for support in probe_levels() if support.is_available]
    found = [Setting(*each) for each in itertools.product(levels, pythons, (1, 2), ("checkout", "wheel"))]
    return sorted(found, key=lambda setting: setting != reference_setting())


def this_version() -> str:
    return f"{sys.version_info.major}.{sys.version_info.minor}"


def find_pythons() -> dict[str, str]:
    """By version: this one; those that ``KIT_OTHER_PYTHONS`` names, which ``.ci/other-pythons`` sets; and those on the
    path and of pyenv that happen to have what the grader needs."""
    found = {this_version(): sys.executable}
    named = os.environ.get("KIT_OTHER_PYTHONS", "").split(os.pathsep)
    around = [shutil.which(f"python3.{minor}") or "" for minor in (11, 12, 13)]
    of_pyenv = sorted(map(str, Path.home().glob(".pyenv/versions/3.1[1-3]*/bin/python")))
    for python in filter(None, (*named, *around, *of_pyenv)):
        try:
            said = subprocess.run(
                [python, "-P", "-c", SAYS], capture_output=True, text=True, timeout=60, check=False
            )
        except (OSError, subprocess.TimeoutExpired):
            continue
        if said.returncode == 0 and re.fullmatch(r"3\.1[1-3]", said.stdout.strip()):
            found.setdefault(said.stdout.strip(), python)
    return found


@dataclass(frozen=True, slots=True)
class Work:
    """One work to an exercise: its solution, its starter, or a wrong one."""

    exercise: str
    """``01-drive/square``."""
    name: str
    path: Path

    @property
    def assignment(self) -> Path:
        return ROOT / "lessons" / self.exercise


def all_works() -> list[Work]:
    """Returns the solutions, starters and wrong works of all exercises, in order."""
    return [
        Work(f"{sheet.parent.parent.name}/{sheet.parent.name}", name, path)
        for sheet in sorted(ROOT.glob("lessons/*/*/assignment.yaml"))
        for name, path in _works_of(sheet.parent)
    ]


def _works_of(assignment: Path) -> Iterator[tuple[str, Path]]:
    solutions = ROOT / "tests" / "solutions" / assignment.parent.name / assignment.name
    for stem, folder in (("solution", solutions), ("starter", assignment)):
        for path in sorted(folder.glob(f"{stem}*")):
            if path.stem == stem and path.name not in IGNORED:
                yield stem, path
    solution = next((path for path in solutions.glob("solution*") if path.stem == "solution"), solutions)
    written = Path(_written_works().name) / assignment.parent.name / assignment.name
    written.mkdir(parents=True, exist_ok=True)
    for path in sorted((solutions / "wrong").glob("*")):  # a challenge of the game has none
        if path.name not in IGNORED and not path.name.startswith("."):
            yield f"wrong-{path.stem}", written_out(path, solution, written)


@cache
def _written_works() -> TemporaryDirectory[str]:
    """Where wrong works that are written as edits are put, until this process ends."""
    return TemporaryDirectory(prefix="kit-works-")


def sample_works() -> list[Work]:
    """Returns the fixed sample: the solution and some wrong works of a few exercises."""
    works = all_works()
    return [
        work
        for exercise in SAMPLE
        for work in [each for each in works if each.exercise == exercise and each.name != "starter"][
            :SAMPLE_WORKS
        ]
    ]


class PointsGrader:
    """Grades works in any setting, in a folder of its own."""

    def __init__(self, folder: Path, pythons: Mapping[str, str]) -> None:
        self._folder = folder
        self._pythons = pythons
        self._wheel: Path | None = None

    def grade(self, works: Iterable[Work], setting: Setting) -> Points:
        """Returns the points of each work. RuntimeError if the grader fails, or grades at another level."""
        with tempfile.TemporaryDirectory(dir=self._folder) as name:
            classes = Path(name) / "classes"
            for work in works:
                _hand_in(work, classes / work.exercise.replace("/", "--"))
            command = [
                self._python(setting),
                "-P",
                str(PROGRAM),
                str(classes),
                str(int(setting.level)),
                str(setting.jobs),
            ]
            done = subprocess.run(
                command, cwd=name, env=self._environment(setting), capture_output=True, text=True, check=False
            )
        if done.returncode != 0:
            raise RuntimeError(f"{setting}: {done.stderr}")
        table = json.loads(done.stdout)
        graded_at = {row.pop() for row in table.values()} - {None}
        if graded_at - {int(setting.level)}:
            raise RuntimeError(f"{setting}: graded at levels {graded_at}")
        return {name.replace("--", "/", 1): row for name, row in table.items()}

    def _python(self, setting: Setting) -> str:
        python = self._pythons[setting.python]
        if setting.installed == "checkout":
            return python
        if self._wheel is None:
            self._wheel = build_wheel(self._folder / "wheel")
        place = self._folder / f"python-{setting.python}"
        return str(
            place / "bin" / "python" if place.exists() else install_wheel(self._wheel, place, python)[0]
        )

    def _environment(self, setting: Setting) -> dict[str, str]:
        kept = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
        own = {"KIT_WORKSPACE": str(self._folder / "workspace"), "PYTHONDONTWRITEBYTECODE": "1"}
        return kept | own | ({"PYTHONPATH": str(ROOT)} if setting.installed == "checkout" else {})


def _hand_in(work: Work, folder: Path) -> None:
    """Puts a work into the class of its exercise, and the exercise beside it."""
    if not folder.exists():
        (folder / "in").mkdir(parents=True)
        shutil.copytree(work.assignment, folder / "assignment", ignore=shutil.ignore_patterns(*IGNORED))
    if work.path.is_dir():
        shutil.copytree(work.path, folder / "in" / work.name, ignore=shutil.ignore_patterns(*IGNORED))
    else:
        shutil.copy(work.path, folder / "in" / f"{work.name}{work.path.suffix}")


def differences(first: Points, other: Points) -> Iterator[str]:
    """Yields the works whose points, or the reasons for them, are not the same."""
    for work in sorted(first.keys() | other.keys()):
        if first.get(work) != other.get(work):
            yield f"{work}: {first.get(work)} and {other.get(work)}"


@click.command(help=__doc__)
@click.option("--sample", is_flag=True, help="Only the fixed sample of works.")
@click.option(
    "--level", "levels", type=click.IntRange(0, 3), multiple=True, help="Only this level; may be repeated."
)
@click.option("--only", default="", help="Only exercises whose name holds this.")
@click.option("--state", type=click.Path(path_type=Path), help="Where the state is kept, to go on from.")
@click.option("--again", is_flag=True, help="Begin anew.")
def main(*, sample: bool, levels: tuple[int, ...], only: str, state: Path | None, again: bool) -> None:
    works = [work for work in (sample_works() if sample else all_works()) if only in work.exercise]
    pythons = find_pythons()
    reference = reference_setting()
    settings = [
        each for each in all_settings(pythons) if not levels or each.level in levels or each == reference
    ]
    file = state or Path(tempfile.gettempdir()) / "kit-points.json"
    if again:
        file.unlink(missing_ok=True)
    graded: dict[str, Points] = json.loads(file.read_bytes()) if file.exists() else {}
    exercises = sorted({work.exercise for work in works})
    steps = [(setting, exercise) for setting in settings for exercise in exercises]
    found: list[str] = []
    with (
        tempfile.TemporaryDirectory(prefix="kit-points-") as folder,
        click.progressbar(steps, label="graded", file=sys.stderr) as bar,
    ):
        grader = PointsGrader(Path(folder), pythons)
        for setting, exercise in bar:
            handed_in = [work for work in works if work.exercise == exercise]
            key = f"{setting}: {exercise}, {len(handed_in)} works"
            if key not in graded:
                graded[key] = grader.grade(handed_in, setting)
                write_atomically(file, json.dumps(graded).encode())
            first = graded[f"{reference}: {exercise}, {len(handed_in)} works"]
            found += [f"{setting}: {each}" for each in differences(first, graded[key])]
    click.echo(
        f"{len(works)} works in {len(settings)} settings (Python {', '.join(pythons)}): {len(found)} differences"
    )
    for line in found:
        click.echo(line)
    raise SystemExit(bool(found))


if __name__ == "__main__":
    main()
