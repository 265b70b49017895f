"""What it costs to grade a class: ``python tests/benchmarks/grading.py [SUBMISSIONS] [JOBS]``.

A seeded mix of good, wrong, stopping, slow and hostile controllers, each of its own bytes, on one assignment with two
episodes of ten simulated seconds at confinement level 1; the hostile ones are the catalogue of attacks, over and over.
Every grade is compared with what that kind of work must get. Then the same again, from the cache; then one submission
at a desk. Exit code 1 if a grade is not what it should be.
"""

from __future__ import annotations

import os
import random
import resource
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import cycle
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from grader.cohort.gradebook import GradebookRow, gradebook_rows
from grader.cohort.queue import Queue
from tests.grader.attacks import ASSIGNMENT_TEXT as ATTACKED
from tests.grader.attacks import ATTACKS, TOKEN, program

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
    subprocess.run(
        [
            *(sys.executable, "-P", "-m", "grader", "cohort", str(folder / "in"), "--jobs", str(jobs)),
            *("--assignment", str(folder / "assignment"), "--queue", str(folder / "queue")),
        ],
        cwd=ROOT,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        check=True,
    )
    return time.perf_counter() - began


def check_one(folder: Path) -> float:
    """Seconds until a student at a desk has the verdict on three episodes."""
    began = time.perf_counter()
    template = ROOT / "grader" / "templates" / "controller"
    subprocess.run(
        [
            *(sys.executable, "-P", "-m", "grader", "check", str(template / "solution.py")),
            *("--assignment", str(template)),
        ],
        cwd=ROOT,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        stdout=subprocess.DEVNULL,
        check=True,
    )
    return time.perf_counter() - began


def figure(name: str, value: float, digits: int = 1) -> None:
    print(f"{name:<42}{value:>10.{digits}f}", flush=True)


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    jobs = int(sys.argv[2]) if len(sys.argv) > 2 else 2
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for part in ("in", "assignment"):
            (folder / part).mkdir()
        (folder / "assignment" / "assignment.yaml").write_text(ASSIGNMENT_TEXT)
        secret = folder / "assignment" / "secret.yaml"
        secret.write_text(f"seeds: {{there: [{TOKEN}]}}\n")
        kind_names = write_class(folder / "in", secret, count)
        mix = ", ".join(f"{number} {kind}" for kind, number in Counter(kind_names.values()).items())
        print(f"submissions: {count} ({mix}), {jobs} jobs")
        figure("load of the machine before", os.getloadavg()[0])
        with Memory() as memory:
            seconds = grade_all(folder, jobs)
        figure("all of them [s]", seconds)
        figure("each [s]", seconds / count, 3)
        usage = resource.getrusage(resource.RUSAGE_CHILDREN)
        figure("processor time of all processes [s]", usage.ru_utime + usage.ru_stime)
        figure("largest process [MiB]", usage.ru_maxrss / 1024)
        figure("all processes together, at most [MiB]", memory.peak / 2**20)
        queue = Queue(folder / "queue")
        table = gradebook_rows(queue)
        print(f"points: {dict(sorted(Counter(row.points for row in table).items(), key=str))}")
        wrong = list(wrong_grades(queue, table, kind_names))
        print("\n".join(wrong) or f"all {len(table)} grades are as they should be")
        figure("again, from the cache [s]", grade_all(folder, jobs))
    figure("at a desk, three episodes [s]", min(check_one(ROOT) for _ in range(3)), 2)
    raise SystemExit(bool(wrong))


if __name__ == "__main__":
    main()
