"""What it costs to grade a class: ``python tests/benchmarks/grading.py [SUBMISSIONS] [JOBS]``.

A seeded mix of good, wrong, slow and hostile controllers, each of its own bytes, on one assignment with two episodes of
ten simulated seconds at confinement level 1. Then the same again, from the cache; then one submission at a desk.
"""

from __future__ import annotations

import os
import random
import resource
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from grader.cohort.gradebook import rows
from grader.cohort.queue import Queue

ROOT = Path(__file__).parents[2]

SHEET = """
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
KINDS = {
    "good": (0.5, SOLUTION),
    "wrong": (0.3, SOLUTION.replace("2.0 * angle", "-2.0 * angle")),
    "stopping": (0.08, SOLUTION.replace("        command = Twist()", "        command = Twist() + 1")),
    "slow": (0.02, SOLUTION.replace("        command = Twist()", ENDLESS + "        command = Twist()")),
    "hostile": (0.1, "import os, sys\nsys.setrecursionlimit(10**6)\nprint('::set-output name=x::y' * 100)\nos._exit(0)\n"),
}  # fmt: skip
"""The share of each kind, and its program."""


def write_class(folder: Path, count: int) -> Counter[str]:
    """The submissions; how many of each kind."""
    chance = random.Random(2026)
    kinds = chance.choices(list(KINDS), [share for share, _ in KINDS.values()], k=count)
    for number, kind in enumerate(kinds):
        (folder / f"{number:05}.py").write_text(f"# {number}\n{KINDS[kind][1]}")
    return Counter(kinds)


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


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    jobs = int(sys.argv[2]) if len(sys.argv) > 2 else 2
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for part in ("in", "assignment"):
            (folder / part).mkdir()
        (folder / "assignment" / "assignment.yaml").write_text(SHEET)
        mix = write_class(folder / "in", count)
        print(
            f"submissions: {count} ({', '.join(f'{number} {kind}' for kind, number in mix.items())}), {jobs} jobs"
        )
        print(f"load of the machine before                {os.getloadavg()[0]:10.1f}")
        seconds = grade_all(folder, jobs)
        print(f"all of them [s]                           {seconds:10.1f}")
        print(f"each [s]                                  {seconds / count:10.3f}")
        usage = resource.getrusage(resource.RUSAGE_CHILDREN)
        print(f"processor time of all processes [s]       {usage.ru_utime + usage.ru_stime:10.1f}")
        print(f"largest process [MiB]                     {usage.ru_maxrss / 1024:10.1f}")
        table = rows(Queue(folder / "queue"))
        print(f"points: {dict(sorted(Counter(row.points for row in table).items(), key=str))}")
        print(f"again, from the cache [s]                 {grade_all(folder, jobs):10.1f}")
    print(f"at a desk, three episodes [s]             {min(check_one(ROOT) for _ in range(3)):10.2f}")


if __name__ == "__main__":
    main()
