"""A task to learn that a student poses: a task file with its world, and perhaps a policy that was trained on it.

It is read and checked as ``kit task check`` does; loops of actions are tried that earn without arriving; and a table
learns it for a short while::

    task:
      algorithm: sarsa         # or q-learning
      steps: 60000             # of each training
      trainings: 2
      episodes: 100            # of each case, in a test
      policy: best.npz         # may be left out: a policy that is handed in beside the task
    seed: 1                    # another one may stand in secret.yaml

No program of the student's runs: rewards are terms with weights.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import Final

from grader.assignment import Assignment
from grader.check import Check, NoParams, check
from grader.evidence.contract import EvidenceCollector, EvidenceOptions, EvidenceRecord, SingleEvidence
from grader.evidence.training_results import PosedTaskPlan
from grader.kinds.contract import AssignmentFiles, KindSettings, SubmissionKind
from grader.kinds.task.sheet_keys import SHEET_KEYS
from grader.kinds.task.task_process import PosedTaskProcess
from grader.problem_text import problems_text
from grader.seeds import read_seed
from grader.submitted_files import reading_submission
from kit.host.failure import StudentCodeError
from kit.learning.tasks.actions import DiscreteActions
from kit.learning.tasks.goals.goal import CaseTargets
from kit.learning.tasks.learning_task import UnknownTask
from kit.learning.tasks.task_reader import read_task
from kit.plain_text import quoted
from kit.world.problems import WorldError

TABLES: Final = ("sarsa", "q-learning")
MAX_STEPS: Final = 500_000
MAX_TRAININGS: Final = 5
MAX_EPISODES: Final = 500
MAX_CASES: Final = 8
MAX_RADIUS: Final = 0.5
"""m: a larger target would be reached without a way that is worth learning. Those of the kit's tasks have 0.12 to 0.4."""


@dataclass(frozen=True, slots=True)
class StartAndTargetParams:
    """Where episodes must begin and end."""

    start: str = ""
    """Corners of an area: x1, y1, x2, y2 [m]; empty: anywhere."""
    target: str = ""


NO_PLACES: Final = MappingProxyType(asdict(StartAndTargetParams()))


@check(none=0, full=1, words=("not sound", "sound"))
def sound(evidence: EvidenceRecord, params: NoParams) -> float:
    """The task cannot be used as it is. `kit task check` tells the same."""
    return 1.0 if evidence.content is not None else 0.0


@check(none=0, full=1, unit="%", params=StartAndTargetParams, is_explained=True)
def places(evidence: EvidenceRecord, params: StartAndTargetParams) -> float:
    """Episodes begin and end where the exercise says in {actual} of the cases."""
    return _measure(evidence, "places", 0.0, params)


@check(none=1, full=4, unit="m")
def way(evidence: EvidenceRecord, params: NoParams) -> float:
    """The shortest way from a start to its target is {actual} long; {full} are wanted."""
    return _measure(evidence, "way", 0.0)


@check(none=0, full=1, unit="%")
def returns(evidence: EvidenceRecord, params: NoParams) -> float:
    """One agent is to drive there and back: {actual} of the cases have one that leads from their target to their start."""
    return _measure(evidence, "returns", 0.0)


@check(none=0.9, full=1, unit="%")
def loops(evidence: EvidenceRecord, params: NoParams) -> float:
    """A robot that never arrives must not earn as much as one that does. That holds for {actual} of the loops that were
    tried."""
    return _measure(evidence, "loops", 0.0)


@check(none=0.2, full=0.7, unit="%")
def learns(evidence: EvidenceRecord, params: NoParams) -> float:
    """A table that learns this task for a short while surely arrives in {actual} of its tests; {full} earns all points.
    (The middle one of its trainings counts. “Surely”: the lower end of Wilson's interval.)"""
    return _measure(evidence, "learns", 0.0)


@check(none=0.5, full=0.9, unit="%")
def arrives(evidence: EvidenceRecord, params: NoParams) -> float:
    """The policy that you handed in with the task surely arrives in {actual} of the episodes; {full} earns all points."""
    return _measure(evidence, "arrives", 0.0)


@check(none=3, full=1.8, unit="times")
def quick(evidence: EvidenceRecord, params: NoParams) -> float:
    """The policy takes {actual} as long as the way would take at full speed, without a turn; {full} earns all points."""
    return _measure(evidence, "quick", math.nan)


def _measure(
    evidence: EvidenceRecord, check: str, otherwise: float, params: StartAndTargetParams | None = None
) -> float:
    """Returns the value of a check; ``otherwise`` for a task that is not sound. A task that takes too much fails, and is no
    fault of the grader's."""
    posed: PosedTaskProcess | None = evidence.content
    if posed is None:
        return otherwise
    try:
        return posed.measure(check, NO_PLACES if params is None else asdict(params)).value
    except StudentCodeError as error:
        evidence.failure = error.failure
        return otherwise


def read_settings(files: AssignmentFiles) -> KindSettings:
    """Reads what is done with a task."""
    section = files.public.section("task")
    seed = read_seed(files.public, 1)
    secret = None if files.secret is None else read_seed(files.secret)
    plan = PosedTaskPlan(
        algorithm=section.text("algorithm", TABLES[0], choices=TABLES),
        steps=section.integer("steps", 60_000, minimum=1_000, maximum=MAX_STEPS),
        trainings=section.integer("trainings", 2, minimum=1, maximum=MAX_TRAININGS),
        episodes=section.integer("episodes", 100, minimum=10, maximum=MAX_EPISODES),
        policy=section.text("policy", ""),
        seed=seed,
        secret_seed=secret,
    )
    if plan.policy and (Path(plan.policy).name != plan.policy or not plan.policy.endswith(".npz")):
        section.error(f"{quoted('policy')} is the name of an .npz file beside the task", "policy")
    section.finish()
    return KindSettings(task=plan, secret_seeds=() if secret is None else (secret,))


@contextmanager
def collect(assignment: Assignment, file: Path, options: EvidenceOptions) -> Iterator[EvidenceCollector]:
    """Reads the task once; with the secret seed where it is used."""
    with ExitStack() as stack:
        public = replace(options, secret=False)
        is_secret = options.secret and bool(assignment.secret_seeds)
        counterpart = (lambda: collect_evidence(assignment, file, public, stack)) if is_secret else None
        yield SingleEvidence(
            lambda: collect_evidence(assignment, file, options, stack),
            options.level,
            counterpart,
            runs_program=False,
        )


def collect_evidence(
    assignment: Assignment, file: Path, options: EvidenceOptions, stack: ExitStack
) -> EvidenceRecord:
    """Reads the task, in a process that ends with ``stack``; what checks measure is worked out when they ask."""
    full = (each.anchors.full for each in assignment.criteria if each.check == learns.name)
    plan: PosedTaskPlan = replace(assignment.task, enough=max(full, default=1.0))
    secret = options.secret and plan.secret_seed is not None
    seed = plan.secret_seed if secret and plan.secret_seed is not None else plan.seed
    record = EvidenceRecord(secret=secret, label="the task with a secret seed" if secret else "the task")
    with reading_submission(file.name):
        problem = _find_problem(file)
    posed = None
    if not problem:
        posed = stack.enter_context(PosedTaskProcess(file, plan, seed, options.level, options.clock))
        try:
            problem = posed.read_task()
        except StudentCodeError as error:
            record.failure = error.failure
            return record
    if problem:
        record.outcome = "not sound"
        record.explain_with = lambda name, params: problem
        return record
    assert posed is not None  # a task without a problem has been read
    record.content, record.outcome, record.steps = posed, "read", plan.steps * plan.trainings
    record.explain_with = lambda name, params: _explain(posed, name, params)
    record.draw_with = lambda name: posed.measure(name, NO_PLACES).picture if name == "learns" else ""
    return record


def _find_problem(file: Path) -> str:
    """Says what in the task's own file keeps it from being used, in words without the path of the temporary copy; empty
    if nothing does."""
    try:
        task = read_task(file).task
        count = len(task.map_cases())
    except (UnknownTask, WorldError, OSError) as error:
        return problems_text(error, file.parent)
    if task.reward_file is not None:
        return (
            f"{file.name}: write the reward as terms with weights; a reward in a Python file is not run here."
        )
    if (
        task.robots != 1
        or not isinstance(task.actions, DiscreteActions)
        or task.goal.case_targets is not CaseTargets.PLACE
    ):
        return f"{file.name}: this needs one robot, discrete actions (twists) and a target."
    if task.target_radius > MAX_RADIUS:
        return (
            f"{file.name}: a target with a radius of {task.target_radius:g} m is met almost anywhere; at most "
            f"{MAX_RADIUS:g} m are taken here."
        )
    if count > MAX_CASES:
        return f"{file.name}: {count} cases are too many to train in a moment; {MAX_CASES} are enough."
    return ""


def _explain(posed: PosedTaskProcess, name: str, params: object) -> str:
    if name == "sound":
        return ""
    return posed.measure(
        name, asdict(params) if isinstance(params, StartAndTargetParams) else NO_PLACES
    ).explanation


CHECKS: Final[Mapping[str, Check]] = MappingProxyType(
    {each.name: each for each in (sound, places, way, returns, loops, learns, arrives, quick)}
)
KIND: Final = SubmissionKind(
    (".yaml", ".yml"),
    CHECKS,
    read_settings,
    collect,
    sheet_keys=SHEET_KEYS,
    exercise="24-train-your-own/pays",
)
