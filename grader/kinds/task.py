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
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

from grader.assignment import Assignment
from grader.checks.contract import Check, NoParams, check
from grader.evidence.contract import EvidenceCollector, EvidenceOptions, EvidenceRecord, FixedEvidence
from grader.evidence.training_results import PosedTaskPlan
from grader.kinds.contract import AssignmentFiles, Kind, KindSettings
from grader.seeds import read_seed
from grader.submitted_files import reading_submission
from grader.task_files import problem_of_task
from kit.host.wire import printable
from kit.learning.environment.actions import DiscreteActions
from kit.learning.environment.task_spec import TaskSpec
from kit.learning.policies.confidence_intervals import lower_bound
from kit.learning.tasks.goals import TargetGoal
from kit.learning.tasks.learning_task import TaskCase
from kit.plain_text import quoted

if TYPE_CHECKING:
    from grader.evidence.posed_task import PosedTask

TABLES: Final = ("sarsa", "q-learning")
MAX_STEPS: Final = 500_000
MAX_TRAININGS: Final = 5
MAX_EPISODES: Final = 500
MAX_CASES: Final = 8


@dataclass(frozen=True, slots=True)
class PlacesParams:
    """Where episodes must begin and end."""

    start: str = ""
    """Corners of an area: x1, y1, x2, y2 [m]; empty: anywhere."""
    target: str = ""


@check(none=0, full=1, words=("not sound", "sound"))
def sound(evidence: EvidenceRecord, params: NoParams) -> float:
    """The task cannot be used as it is. `kit task check` tells the same."""
    return 1.0 if _posed(evidence) is not None else 0.0


@check(none=0, full=1, unit="%", params=PlacesParams)
def places(evidence: EvidenceRecord, params: PlacesParams) -> float:
    """Episodes begin and end where the exercise says in {actual} of the cases."""
    posed = _posed(evidence)
    if posed is None:
        return 0.0
    return sum(not list(_misplaced(case, params)) for case in posed.cases) / len(posed.cases)


@check(none=1, full=4, unit="m")
def way(evidence: EvidenceRecord, params: NoParams) -> float:
    """The shortest way from a start to its target is {actual} long; {full} are wanted."""
    posed = _posed(evidence)
    return 0.0 if posed is None else min(posed.ways)


@check(none=0.9, full=1, unit="%")
def loops(evidence: EvidenceRecord, params: NoParams) -> float:
    """A robot that never arrives must not earn as much as one that does. That holds for {actual} of the loops that were
    tried."""
    posed = _posed(evidence)
    if posed is None or math.isnan(posed.arriving_reward):
        return 0.0
    return 1.0 - len(posed.paying_loops) / len(posed.loops)


@check(none=0.2, full=0.7, unit="%")
def learns(evidence: EvidenceRecord, params: NoParams) -> float:
    """A table that learns this task for a short while surely arrives in {actual} of its tests; {full} earns all points.
    (The best of its trainings counts. “Surely”: the lower end of Wilson's interval.)"""
    posed = _posed(evidence)
    if posed is None:
        return 0.0
    exams = [training.exam.values() for training in posed.results.trainings]
    return max(
        lower_bound(sum(count.reached for count in exam), sum(count.episodes for count in exam))
        for exam in exams
    )


@check(none=0.5, full=0.9, unit="%")
def arrives(evidence: EvidenceRecord, params: NoParams) -> float:
    """The policy that you handed in with the task surely arrives in {actual} of the episodes; {full} earns all points."""
    posed = _posed(evidence)
    if posed is None or isinstance(posed.policy_test, str):
        return 0.0
    cases = posed.policy_test.cases
    return lower_bound(sum(case.reached for case in cases), sum(case.episodes for case in cases))


@check(none=3, full=1.8, unit="times")
def quick(evidence: EvidenceRecord, params: NoParams) -> float:
    """The policy takes {actual} as long as the way would take at full speed, without a turn; {full} earns all points."""
    posed = _posed(evidence)
    if posed is None or isinstance(posed.policy_test, str):
        return math.nan
    steps = [case.steps for case in posed.policy_test.cases if case.reached]
    return max(steps) * posed.task.step_time / posed.shortest_seconds() if steps else math.nan


def _posed(evidence: EvidenceRecord) -> PosedTask | None:
    """The task; None if it is not sound."""
    found: PosedTask | None = evidence.content
    return found


def _misplaced(case: TaskCase, params: PlacesParams) -> Iterator[str]:
    """What of a case lies elsewhere than asked, in words."""
    for name, asked, spots in (
        ("starts", params.start, case.starts[0]),
        ("target", params.target, case.targets),
    ):
        if not asked:
            continue
        x1, y1, x2, y2 = (float(number) for number in asked.split())
        corners = [(spots.area[0], spots.area[1]), (spots.area[2], spots.area[3])] if spots.area else []
        points = corners or [(pose.x, pose.y) for pose in spots.poses]
        for x, y in points:
            if not (x1 <= x <= x2 and y1 <= y <= y2):
                yield f"{case.name}: ({x:g}, {y:g}), one of its {name}, is not between ({x1:g}, {y1:g}) and ({x2:g}, {y2:g})"


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


def collect(
    assignment: Assignment, file: Path, options: EvidenceOptions
) -> AbstractContextManager[EvidenceCollector]:
    """Reads the task once; with the secret seed where it is used."""
    record, public = collect_evidence(assignment, file, options), replace(options, secret=False)
    counterpart = (lambda: collect_evidence(assignment, file, public)) if record.secret else None
    return nullcontext(FixedEvidence([record], options.level, counterpart))


def collect_evidence(assignment: Assignment, file: Path, options: EvidenceOptions) -> EvidenceRecord:
    """Reads the task; what checks measure is worked out when they ask."""
    plan: PosedTaskPlan = assignment.task
    secret = options.secret and plan.secret_seed is not None
    seed = plan.secret_seed if secret and plan.secret_seed is not None else plan.seed
    with reading_submission(file.name):
        problem = _problem(file)
    posed = None
    if not problem:
        # Only now: it loads all that learning takes, and a slip is told at once.
        from grader.evidence.posed_task import PosedTask

        posed = PosedTask(file, plan, seed, options.clock)
    return EvidenceRecord(
        posed,
        secret=secret,
        label="the task with a secret seed" if secret else "the task",
        outcome="read" if posed is not None else "not sound",
        steps=0 if posed is None else plan.steps * plan.trainings,
        explain_with=lambda name, params: _explain(posed, problem, name, params),
        draw_with=lambda name: posed.results.picture() if posed is not None and name == "learns" else "",
    )


def _problem(file: Path) -> str:
    """What keeps the task from being used, in words without the path of the temporary copy; empty if nothing does."""
    found = problem_of_task(file)
    if found is not None:
        return printable(found.replace(f"{file.parent}/", ""))
    task = TaskSpec(str(file)).resolve()
    if task.reward_file is not None:
        return (
            f"{file.name}: write the reward as terms with weights; a reward in a Python file is not run here."
        )
    if (
        task.robots != 1
        or not isinstance(task.actions, DiscreteActions)
        or not isinstance(task.goal, TargetGoal)
    ):
        return f"{file.name}: one robot, a table of actions (twists) and a target are asked for here."
    if len(task.map_cases()) > MAX_CASES:
        return f"{file.name}: {len(task.map_cases())} cases are too many to train in a moment; {MAX_CASES} are enough."
    return ""


def _explain(posed: PosedTask | None, problem: str, name: str, params: object) -> str:
    if posed is None:
        return problem
    if name == "places" and isinstance(params, PlacesParams):
        return next((text for case in posed.cases for text in _misplaced(case, params)), "")
    if name == "loops":
        if math.isnan(posed.arriving_reward):
            return (
                "A robot that was taught by the kit's own reward never arrived, so there is nothing to compare with: does "
                "it see enough, can it turn, is there time enough?"
            )
        if posed.paying_loops:
            best = posed.paying_loops[0]
            return (
                f"The best of them: {best}. It earns {best.total_reward:.4g} and never arrives; who arrives earns "
                f"{posed.arriving_reward:.4g}."
            )
    if name == "learns":
        shares = ", ".join(f"{training.accuracy:.2f}" for training in posed.results.trainings)
        return f"The tests of its trainings: {shares}."
    if name in ("arrives", "quick"):
        if isinstance(posed.policy_test, str):
            return posed.policy_test
        worst_case = posed.policy_test.worst
        return f"The worst case is {worst_case.case}, reached {worst_case.reached} times in {worst_case.episodes}."
    return ""


CHECKS: Final[Mapping[str, Check]] = MappingProxyType(
    {each.name: each for each in (sound, places, way, loops, learns, arrives, quick)}
)
KIND: Final = Kind((".yaml", ".yml"), CHECKS, read_settings, collect)
