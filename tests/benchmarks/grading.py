"""What it costs to grade a class: ``python tests/benchmarks/grading.py``; ``--help`` shows how to do less.

A seeded mix of good, wrong, stopping, slow and hostile controllers, each of its own bytes, on one assignment with two
episodes of ten simulated seconds at confinement level 1; the hostile ones are the catalogue of attacks, over and over.
Every grade is compared with what that kind of work must get. Then the same again, from the cache. Then a class of honest
works alone, a class with every bomb, and students' own checks. Exit code 1 if a grade is not what it should be.
"""

from __future__ import annotations

import os
import random
import re
import resource
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from itertools import cycle
from pathlib import Path
from statistics import median
from types import MappingProxyType

import click

sys.path.insert(0, str(Path(__file__).parents[2]))

from grader.cohort.gradebook import GradebookRow, gradebook_rows
from grader.cohort.queue import Queue
from tests.grader.attack import ASSIGNMENT_TEXT as ATTACKED
from tests.grader.attack import TOKEN, program
from tests.grader.attacks import ATTACKS
from tests.grader.cohort.test_unreadable import MAX_MIB, prepare_bombs

ROOT = Path(__file__).parents[2]

ASSIGNMENT_TEXT = """
title: Round the corner
submit: controller.py
level: 1
budget: {reply: 3, total: 30, cpu: 20}
trials:
  - {name: there, place: turn, case: turn_a_to_b, time: 10, seeds: [1], shift: [0.05, 0.05, 0.2]}
  - {name: back, place: turn, case: turn_b_to_a, time: 10, seeds: [1], shift: [0.05, 0.05, 0.2]}
checks:
  - {check: runs, points: 1}
  - {check: reached, points: 6, after: runs}
  - {check: clearance, points: 3, after: reached, share: {none: 0, full: 0.03}}
"""

FIRST_BUILD_S = 508
"""What the kit's first build took for 1,000 of this mix on two cores [s]."""

SOLUTION = (ROOT / "grader" / "templates" / "controller" / "solution.py").read_text()
ENDLESS = "\n        while True:\n            pass\n"
SHARES = {"good": 0.5, "wrong": 0.3, "stopping": 0.08, "slow": 0.02, "hostile": 0.1}
PROGRAMS = {
    "good": SOLUTION,
    "wrong": SOLUTION.replace("2.0 * angle", "-2.0 * angle"),
    "stopping": SOLUTION.replace("        command = Twist()", "        command = Twist() + 1"),
    "slow": SOLUTION.replace("        command = Twist()", ENDLESS + "        command = Twist()"),
}
POINTS = {"good": {10.0}, "wrong": {1.0}, "stopping": {0.0}, "slow": {0.0}, "hostile": {0.0, 1.0}}
"""What each kind must get; an attack that does no harm has run to the end, for one point."""
STATUS = {"good": {"pass"}, "wrong": {"pass"}, "stopping": {"student_error"}, "slow": {"timeout"}}
"""How the check `runs` must end."""


def hostile(secret: Path) -> Iterator[str]:
    """The programs of the catalogue that come alone and come back, in turn."""
    return cycle(
        program(attack, secret, secret.with_name("results.json"))
        for attack in ATTACKS
        if attack.sheet == ATTACKED and not attack.files and attack.pack is None
    )


def write_class(folder: Path, secret: Path, count: int) -> dict[str, str]:
    """The submissions; which kind each of them is."""
    chance = random.Random(2026)
    kind_names = chance.choices(list(SHARES), list(SHARES.values()), k=count)
    attacks = hostile(secret)
    made = {}
    for number, kind in enumerate(kind_names):
        name = f"{number:05}"
        source = next(attacks) if kind == "hostile" else PROGRAMS[kind]
        (folder / f"{name}.py").write_text(f"# {number}\n{source}")
        made[name] = kind
    return made


def wrong_grades(queue: Queue, table: Sequence[GradebookRow], kind_names: dict[str, str]) -> Iterator[str]:
    """A line for every grade that is not what it should be, and for every secret that got out."""
    for row in table:
        kind = kind_names[row.name]
        status = row.statuses.get("runs", "none")
        if row.points not in POINTS[kind] or status not in STATUS.get(kind, {status}):
            yield f"{row.name} ({kind}): {row.points} points, runs: {status}. {row.note}"
    for file in (queue.folder / "results").iterdir():
        content = file.read_text()
        if TOKEN in content or "GOT " in content:
            yield f"{file.name}: an attack got what it wanted"


class Memory:
    """The most that all processes below this one have had in memory together, looked at five times a second."""

    def __init__(self) -> None:
        self.peak = 0
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._look, daemon=True)

    def __enter__(self) -> Memory:
        self._thread.start()
        return self

    def __exit__(self, *error: object) -> None:
        self._over.set()
        self._thread.join()

    def _look(self) -> None:
        while not self._over.wait(0.2):
            self.peak = max(self.peak, self._now())

    def _now(self) -> int:
        above, size = {}, {}
        for entry in Path("/proc").glob("[0-9]*"):
            try:
                fields = (entry / "stat").read_text().rpartition(")")[2].split()
            except OSError:
                continue
            above[int(entry.name)] = int(fields[1])
            size[int(entry.name)] = int(fields[21]) * os.sysconf("SC_PAGE_SIZE")
        return sum(size[each] for each in size if self._is_ours(each, above))

    @staticmethod
    def _is_ours(process: int, above: dict[int, int]) -> bool:
        while process in above:
            process = above[process]
            if process == os.getpid():
                return True
        return False


def grade_all(folder: Path, jobs: int) -> float:
    """Seconds that the command takes."""
    began = time.perf_counter()
    run_grader(
        *("cohort", str(folder / "in"), "--jobs", str(jobs), "--level", "1"),
        *("--assignment", str(folder / "assignment"), "--queue", str(folder / "queue")),
    )
    return time.perf_counter() - began


def run_grader(*arguments: str, environment: Mapping[str, str] = MappingProxyType({})) -> int:
    """Runs the grader's command; returns its exit code. RuntimeError if it could not do what it was told."""
    done = subprocess.run(
        [sys.executable, "-P", "-m", "grader", *arguments],
        cwd=ROOT,
        env=os.environ | {"PYTHONPATH": str(ROOT)} | dict(environment),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        check=False,
    )
    if done.returncode > 1:
        raise RuntimeError(f"grader {' '.join(arguments)}: {done.stderr}")
    return done.returncode


def seconds_of_check(
    work: Path, assignment: Path, environment: Mapping[str, str] = MappingProxyType({})
) -> float:
    """Seconds until a student has the verdict on this work."""
    began = time.perf_counter()
    run_grader("check", str(work), "--assignment", str(assignment), environment=environment)
    return time.perf_counter() - began


def used_s() -> float:
    """Processor time of all processes that have been waited for [s]."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def measure_honest(folder: Path, count: int, jobs: int) -> None:
    """Prints the processor time of a class of good and wrong works, for each."""
    (folder / "in").mkdir(parents=True)
    (folder / "assignment").mkdir()
    (folder / "assignment" / "assignment.yaml").write_text(ASSIGNMENT_TEXT)
    for number in range(count):
        source = PROGRAMS["wrong" if number % 8 > 4 else "good"]  # as in the mix
        (folder / "in" / f"{number:05}.py").write_text(f"# {number}\n{source}")
    before = used_s()
    grade_all(folder, jobs)
    figure("honest work at level 1, each [core-s]", (used_s() - before) / count, 2, "at most 0.5")


def measure_own_checks(folder: Path, repeats: int, cold: int) -> None:
    """Prints how long students wait for the verdict on the lessons' controller exercises, warm and cold."""
    sheets = sorted(
        sheet.parent
        for sheet in (ROOT / "lessons").glob("*/*/assignment.yaml")
        if re.search("^kind: controller$", sheet.read_text(), re.MULTILINE)
    )
    warm = []
    for sheet in sheets:
        work = ROOT / "tests" / "solutions" / sheet.parent.name / sheet.name / "solution.py"
        work = work if work.exists() else sheet / "starter.py"
        warm.append(median(seconds_of_check(work, sheet) for _ in range(repeats)))
        figure(f"own check of {sheet.name} [s]", warm[-1], 2)
        if cold:
            cold -= 1
            caches = {"NUMBA_CACHE_DIR": str(folder / sheet.name / "numba"),
                      "PYTHONPYCACHEPREFIX": str(folder / sheet.name / "python")}  # fmt: skip
            figure("  cold, nothing compiled [s]", seconds_of_check(work, sheet, caches), 2)
    figure("own check, median over exercises [s]", median(warm), 2, "under 2 when idle")
    broken = folder / "broken.py"
    broken.write_text("def main(:\n")
    broken_s = median(seconds_of_check(broken, sheets[0]) for _ in range(repeats))
    figure("own check of a syntax error [s]", broken_s, 2, "under 0.5 when idle")


def figure(name: str, value: float, digits: int = 1, wanted: str = "") -> None:
    """Prints one line; ``wanted`` is what is aimed at, or what was measured before."""
    beside = f"   ({wanted})" if wanted else ""
    print(f"{name:<42}{value:>10.{digits}f}{beside}", flush=True)


def measure_class(folder: Path, count: int, jobs: int) -> bool:
    """Prints what the mix costs; returns whether every grade is as it should be."""
    for part in ("in", "assignment"):
        (folder / part).mkdir(parents=True)
    (folder / "assignment" / "assignment.yaml").write_text(ASSIGNMENT_TEXT)
    secret = folder / "assignment" / "secret.yaml"
    secret.write_text(f"seeds: {{there: [{TOKEN}]}}\n")
    kind_names = write_class(folder / "in", secret, count)
    mix = ", ".join(f"{number} {kind}" for kind, number in Counter(kind_names.values()).items())
    print(f"submissions: {count} ({mix}), {jobs} jobs")
    figure("load of the machine before", os.getloadavg()[0])
    before = used_s()
    with Memory() as memory:
        seconds = grade_all(folder, jobs)
    figure("all of them [s]", seconds, 1, f"first build: {FIRST_BUILD_S * count / 1000:.0f}, of two cores")
    figure("each [s]", seconds / count, 3, f"first build: {FIRST_BUILD_S / 1000:.3f}")
    figure("processor time of all processes [s]", used_s() - before)
    figure("largest process [MiB]", resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024)
    figure("all processes together, at most [MiB]", memory.peak / 2**20)
    queue = Queue(folder / "queue")
    table = gradebook_rows(queue)
    print(f"points: {dict(sorted(Counter(row.points for row in table).items(), key=str))}")
    wrong = list(wrong_grades(queue, table, kind_names))
    print("\n".join(wrong) or f"all {len(table)} grades are as they should be")
    figure("again, from the cache [s]", grade_all(folder, jobs), 1, "first build: 3 for 1,000")
    return not wrong


@click.command(help=__doc__)
@click.argument("submissions", type=click.IntRange(0), default=1000)
@click.argument("jobs", type=click.IntRange(1), default=2)
@click.option(
    "--honest", type=click.IntRange(0), default=40, show_default=True, help="Honest works, graded alone."
)
@click.option("--bombs/--no-bombs", default=True, show_default=True, help="Prepare a class with every bomb.")
@click.option("--repeats", type=click.IntRange(0), default=3, show_default=True, help="Of each own check.")
@click.option(
    "--cold", type=click.IntRange(0), default=2, show_default=True, help="Own checks without caches."
)
def main(*, submissions: int, jobs: int, honest: int, bombs: bool, repeats: int, cold: int) -> None:
    is_right = True
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if submissions:
            is_right = measure_class(folder / "class", submissions, jobs)
        if honest:
            measure_honest(folder / "honest", honest, jobs)
        if bombs:
            peak, refused = prepare_bombs(folder / "bombs")
            figure(f"preparing {len(refused)} works with bombs [MiB]", peak, 0, f"under {MAX_MIB}")
        if repeats:
            measure_own_checks(folder, repeats, cold)
    raise SystemExit(not is_right)


if __name__ == "__main__":
    main()
