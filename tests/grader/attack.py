"""What an attack on the grader is, how it is handed in, and what is seen of it. The rows are in ``attacks`` and
``further_attacks``."""

from __future__ import annotations

import io
import os
import tarfile
import textwrap
import zipfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from grader.assignment import Assignment
from grader.grading import GradingOptions, grade
from grader.reading import read_assignment
from grader.submission import read_submission
from grader.submitted_files import SubmissionRefused
from kit.host.sandbox.probe import can_mount_scratch, highest_level_up_to
from kit.host.sandbox.sandbox_config import Level
from kit.results.grading_result import CriterionStatus, GradingResult

TOKEN = "735192468013"
"""A secret: in the assignment, in the grader's environment, in its memory."""

ASSIGNMENT_TEXT = """
title: Nothing here is easy
submit: controller.py
budget: {start: 30, reply: 8, total: 20, cpu: 10, memory: 512}
trials: [{name: turn, place: turn, time: 0.6, seeds: [1]}]
checks:
  - {check: runs, points: 1}
  - {check: reached, points: 8}
  - {check: obeys, points: 1, after: runs}
"""

HASTY = ASSIGNMENT_TEXT.replace(
    "start: 30, reply: 8, total: 20, cpu: 10", "start: 2, reply: 0.5, total: 1, cpu: 2"
)
"""For those that never come back: no need to wait for them."""

REWARD_SHEET = """
title: Nor this
kind: reward
submit: controller.py
budget: {start: 30, reply: 8, total: 20, cpu: 10, memory: 512}
grid: {discount: 0.95, max_steps: 40, map: "#####\\n#...#\\n#..G#\\n#####"}
checks:
  - {check: contract, points: 1}
  - {check: pure, points: 1, after: contract}
  - {check: planned, points: 8, after: contract}
"""

PROGRAM = """
import os, sys
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist

SECRET = {secret!r}
GRADER = {grader!r}
VICTIM = {victim!r}

def got(what):
    print("GOT", what, flush=True)

def attack(node):
{body}

class Hostile(Node):
    def __init__(self):
        super().__init__("hostile")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(0.1, self.once)
        self.done = False

    def once(self):
        if not self.done:
            self.done = True
            try:
                attack(self)
            except {caught} as error:
                print("refused", type(error).__name__)

def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Hostile())
"""


@dataclass(frozen=True)
class End:
    """How an attack may end: what it earns, honestly, and the status that says why it earns no more."""

    points: float
    status: str


RAN = End(2.0, "fail")
"""It went on as a program that does nothing: no error, nothing reached, the world left alone."""
STOPPED = End(0.0, "student_error")
SLOW = End(0.0, "timeout")
LARGE = End(0.0, "resource_limit")
ODD = End(0.0, "protocol_error")
DISOBEYED = End(1.0, "fail")
REFUSED = End(-1.0, "refused")
"""Not graded at all."""

Files = Mapping[str, bytes]


@dataclass(frozen=True)
class Attack:
    """One row."""

    row: int
    name: str
    body: str = ""
    end: End = RAN
    least: int = 0
    """From which level on it is held. Below, only what the grader itself does is in its way."""
    whole: str = ""
    """A whole program instead of a body."""
    files: Files = field(default_factory=dict)
    """Handed in beside it."""
    pack: Callable[[Path], None] | None = None
    """Makes what is handed in by itself."""
    sheet: str = ASSIGNMENT_TEXT
    caught: str = "Exception"
    """What the program catches of its own attack."""
    assignment_files: Files = field(default_factory=dict)
    """In the assignment's folder, beside ``secret.yaml``."""
    control: Callable[[Path], bool] | None = None
    """Whether the attack works where the defence is missing: on a reader, a writer or a process without it. Gets an empty
    folder. None: see ``works_undefended``."""
    lift: Callable[[Assignment], Assignment] | None = None
    """Returns the assignment without the limit that stops the attack."""
    end_in_own_files: End | None = None
    """How it ends where the program's own file system is full, if that is another way: from level 2 on, and at level 1 wherever
    that may be mounted."""

    @property
    def kind(self) -> str:
        """The kind of assignment, or ``archive`` for what never gets so far."""
        if self.pack is not None:
            return "archive"
        lines = [line for line in self.sheet.splitlines() if line.startswith("kind: ")]
        return lines[0].partition(" ")[2] if lines else "controller"


def write_zip(path: Path, entries: Mapping[str, bytes], mode: int = 0o100644) -> None:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in entries.items():
            entry = zipfile.ZipInfo(name)
            entry.external_attr = mode << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, content)


def write_tar(path: Path, name: str, kind: bytes, link: str = "") -> None:
    with tarfile.open(path, "w") as archive:
        entry = tarfile.TarInfo(name)
        entry.type, entry.linkname = kind, link
        archive.addfile(entry, io.BytesIO())


HARMLESS = "import rclpy\nfrom rclpy.node import Node\nrclpy.init()\nrclpy.spin(Node('harmless'))\n"


def program(attack: Attack, secret: Path, victim: Path) -> str:
    """What is handed in. ``secret``: a file it should not read; ``victim``: one it should not write."""
    if attack.whole:
        return attack.whole.replace("SECRET_FILE", str(secret))
    body = textwrap.indent(attack.body.strip() or "pass", "    ")
    return PROGRAM.format(
        secret=str(secret), grader=os.getpid(), victim=str(victim), body=body, caught=attack.caught
    )


@dataclass(frozen=True)
class Outcome:
    """What became of an attack."""

    result: GradingResult | None
    refused: str
    got: str
    """What it says it got; empty if nothing."""

    @property
    def points(self) -> float | None:
        return -1.0 if self.result is None else self.result.points

    @property
    def status(self) -> str:
        if self.result is None:
            return "refused"
        statuses = [test.status for test in self.result.tests]
        worst = [
            each
            for each in statuses
            if each not in (CriterionStatus.PASS, CriterionStatus.FAIL, CriterionStatus.SKIPPED)
        ]
        return (
            worst or [CriterionStatus.FAIL if CriterionStatus.FAIL in statuses else CriterionStatus.PASS]
        )[0].value

    def holds(self, attack: Attack, level: Level) -> bool:
        """Whether it got nothing, earned what was honest, and was told the right reason."""
        own_disk = Level.FILTERED if can_mount_scratch() else Level.SEPARATE
        in_own_files = level >= own_disk and attack.end_in_own_files is not None
        end = (attack.end_in_own_files if in_own_files else None) or attack.end
        return not self.got and self.points == end.points and self.status == end.status


def attempt(attack: Attack, level: Level, folder: Path, *, lifted: bool = False) -> Outcome:
    """Hands it in and has it graded. ``lifted``: without the limit that stops it."""
    assignment_folder = folder / "assignment"
    assignment_folder.mkdir()
    (assignment_folder / "assignment.yaml").write_text(attack.sheet)
    secret = assignment_folder / "secret.yaml"
    if attack.kind in ("controller", "archive"):
        secret.write_text(f"seeds: {{turn: [{TOKEN}]}}\n")
    for name, content in attack.assignment_files.items():
        (assignment_folder / name).write_bytes(content)
    assignment = read_assignment(assignment_folder)
    if lifted and attack.lift is not None:
        assignment = attack.lift(assignment)
    victim = folder / "victim.txt"
    if not victim.exists():
        victim.write_text("untouched")
    handed = folder / "handed"
    if attack.pack is not None:
        attack.pack(handed)
        handed = next(path for path in folder.iterdir() if path.name.startswith("handed"))
    else:
        handed.mkdir()
        source = program(attack, secret, victim)
        (handed / assignment.submit).write_text(source, encoding="utf-8")
        for name, content in attack.files.items():
            (handed / name).write_bytes(content)
    try:
        result = grade(
            assignment,
            read_submission(handed, assignment.submit),
            GradingOptions(level, may_lower_level=False),
        )
    except SubmissionRefused as refused:
        return Outcome(None, str(refused), "")
    printed = "\n".join(f"{test.log}\n{test.rationale}" for test in result.tests)
    got = next((line for line in printed.splitlines() if line.startswith("GOT") or TOKEN in line), "")
    return Outcome(result, "", got)


def works_undefended(attack: Attack, folder: Path) -> bool | None:
    """Whether an attack works where what stops it is missing; None if nothing is known of that.

    What needs confinement is tried at level 0, what a limit stops without that limit, anything else by its ``control``.
    """
    if attack.control is not None:
        return attack.control(folder)
    if attack.lift is not None:
        level = highest_level_up_to(Level.FILTERED)
        return attempt(attack, level, folder, lifted=True).status != attack.end.status
    if attack.least == 0:
        return None
    outcome = attempt(attack, Level.LIMITED, folder)
    return bool(outcome.got) or (outcome.points or 0.0) > attack.end.points
