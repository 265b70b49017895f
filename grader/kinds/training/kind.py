"""The settings of a training, in a YAML file: trained with several seeds and graded by the policies they keep.

The assignment sets what is to be learned and what it may cost::

    training:
      task: turn               # a task of the kit's, or a task file in this folder: my_task.yaml
      reward: progress
      scale: 1.0
      algorithms: [q-learning, sarsa]
      steps: 150000            # of each training, at most
      seeds: [1, 2, 3]         # a training each; others may stand in secret.yaml
      episodes: 200            # of each case, in the exam after each training
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import Final

from grader.assignment import Assignment
from grader.check import Check, check
from grader.evidence.contract import EvidenceOptions, EvidenceRecord
from grader.evidence.training_results import (
    CaseOrder,
    StopRule,
    TrainingBudget,
    TrainingResults,
    TrainingSettings,
)
from grader.kinds.contract import (
    AssignmentFiles,
    KindSettings,
    SubmissionKind,
    collect_once,
    read_submitted_yaml,
)
from grader.kinds.training.sheet_keys import SHEET_KEYS
from grader.seeds import MAX_SEED
from grader.task_files import read_task_choice
from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.wire import printable
from kit.learning.tasks.actions import DiscreteActions
from kit.learning.tasks.learning_task import UnknownTask
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.algorithm_settings import LinearSchedule
from kit.learning.training.algorithms import (
    ALGORITHMS,
    UnknownAlgorithm,
    UnsuitableAlgorithm,
    check_suits,
    find_algorithm,
)
from kit.learning.training.learn_extra import LearnExtraMissing
from kit.plain_text import quoted, suggestion
from kit.world.yaml_section import Section

MAX_STEPS: Final = 5_000_000
MAX_SEEDS: Final = 20
MAX_WORLDS: Final = 256
MAX_TEST_EPISODES: Final = 2_000
MAX_TESTS: Final = 100
"""Tests of one training: more would take longer than the training."""
MAX_EDGES: Final = 4
TABLES: Final = ("q-learning", "sarsa")


@dataclass(frozen=True, slots=True)
class ReliableParams:
    """The success that a single training needs to count."""

    goal: float = 0.9


@check(none=0.5, full=0.9, unit="%")
def succeeds(evidence: EvidenceRecord, params: object) -> float:
    """After these trainings the robot surely reaches its target in {actual} of the episodes; {full} earns all points.
    (“Surely”: the lower end of Wilson's interval, all exams together.)"""
    results: TrainingResults = evidence.content
    return results.success_lower_bound()


@check(none=0.4, full=0.85, unit="%")
def every_case(evidence: EvidenceRecord, params: object) -> float:
    """In the case that goes worst the robot surely reaches its target in {actual} of the episodes; {full} earns all
    points."""
    results: TrainingResults = evidence.content
    return results.success_lower_bound(results.worst_case)


RESTLESS_RATE: Final = 0.1
"""With a learning rate above this at the end of a training, values do not come to rest."""


@check(none=0.5, full=0.8, unit="%")
def remembers(evidence: EvidenceRecord, params: object) -> float:
    """At the end of the training the newest policy reaches the target in {actual} of the tests of its worst case; {full}
    earns all points. A policy that was put aside in time does not help here."""
    results: TrainingResults = evidence.content
    return min(results.last_tests(case).share for case in results.budget.cases)


@check(none=0.3, full=1, unit="%", params=ReliableParams)
def reliable(evidence: EvidenceRecord, params: ReliableParams) -> float:
    """Only {actual} of the trainings led to a policy that is good enough: the others had less luck with their seed."""
    results: TrainingResults = evidence.content
    return sum(training.accuracy >= params.goal for training in results.trainings) / len(results.trainings)


@check(none=0.25, full=0.08)
def honest(evidence: EvidenceRecord, params: object) -> float:
    """What a training's own last test says of its policy must be true: it promised {actual} more, as a share of
    episodes, than the exam found; {full} is allowed."""
    results: TrainingResults = evidence.content
    return max(max(0.0, training.claimed - training.accuracy) for training in results.trainings)


@dataclass(frozen=True, slots=True)
class StepsUsedParams:
    """What a test must ask of a policy, so that the training which it ends counts as ended by it."""

    goal: float = 0.8


@check(none=1.0, full=0.7, unit="%", params=StepsUsedParams)
def steps_used(evidence: EvidenceRecord, params: StepsUsedParams) -> float:
    """The trainings used {actual} of the steps they might; {full} or less earns all points. One that no test with a goal
    worth the name ended counts as if it had used them all. When is it good enough?"""
    results: TrainingResults = evidence.content
    allowed, is_told = results.budget.steps, results.settings.goal >= params.goal
    used = [each.steps if each.is_stopped and is_told else allowed for each in results.trainings]
    return sum(used) / (len(used) * allowed)


def read_settings(files: AssignmentFiles) -> KindSettings:
    """Reads the task and the budget."""
    section = files.public.section("training")
    found = read_task_choice(section, files.folder)
    choice = replace(
        TaskSpec("turn") if found is None else found,
        reward=section.text("reward") if section.has("reward") else None,
        scale=section.number("scale", above=0) if section.has("scale") else None,
    )
    algorithms = section.texts("algorithms", TABLES, at_least=1)
    steps = section.integer("steps", minimum=1_000, maximum=MAX_STEPS)
    episodes = section.integer("episodes", 200, minimum=10, maximum=2_000)
    seeds, secret = _read_seeds(section), () if files.secret is None else _read_seeds(files.secret)
    for each in algorithms:
        if each not in ALGORITHMS:
            section.error(f"no algorithm {quoted(each)}: {suggestion(each, ALGORITHMS)}", "algorithms")
    section.finish()
    if found is None:
        return KindSettings()
    try:
        cases = tuple(case.name for _, case in choice.resolve().map_cases())
    except UnknownTask as error:
        section.error(str(error), "task")
        return KindSettings()
    is_continuous = not isinstance(choice.resolve().actions, DiscreteActions)
    for each in algorithms:
        try:
            check_suits(find_algorithm(each), is_continuous=is_continuous)
        except UnknownAlgorithm:
            continue  # noted above
        except UnsuitableAlgorithm as error:
            section.error(str(error), "algorithms")
    budget = TrainingBudget(choice, cases, algorithms, steps, seeds, secret, episodes)
    return KindSettings(task=budget, secret_seeds=secret)


def _read_seeds(section: Section) -> tuple[int, ...]:
    return section.integers("seeds", minimum=0, maximum=MAX_SEED, at_least=1, at_most=MAX_SEEDS)


def collect_evidence(assignment: Assignment, file: Path, options: EvidenceOptions) -> EvidenceRecord:
    """Trains with the submitted settings, once for each seed."""
    budget: TrainingBudget = assignment.task
    settings = read_submitted_yaml(file, lambda section: _read_settings(section, budget))
    if isinstance(settings, Failure):
        return EvidenceRecord(failure=settings)
    secret = options.secret and bool(budget.secret_seeds)
    from grader.kinds.training.trainings import run_trainings  # only now: it loads all that learning takes

    try:
        seeds = budget.secret_seeds if secret else budget.seeds
        results = run_trainings(settings, budget, seeds, options.clock)
    except LearnExtraMissing as error:
        return _failure_record(Failure(FailureKind.IMPORT, printable(str(error))))
    except StudentCodeError as error:
        return _failure_record(error.failure)
    return EvidenceRecord(
        results,
        secret=secret,
        label="the trainings with secret seeds" if secret else "the trainings",
        outcome="trained",
        steps=sum(training.steps for training in results.trainings),
        explain_with=lambda check, params: _explain(results, check),
        draw_with=lambda check: results.picture(),
    )


def _failure_record(failure: Failure) -> EvidenceRecord:
    return EvidenceRecord(failure=failure, label="the trainings", outcome="not trained")


def _explain(results: TrainingResults, check: str) -> str:
    """Explains which training or case lost the points."""
    if check == "every_case":
        count = results.pooled_count(results.worst_case)
        return f"That is {results.worst_case}, reached {count.reached} times in {count.episodes}."
    if check == "remembers":
        return _explain_what_is_left(results)
    if check in ("succeeds", "reliable"):
        shares = ", ".join(f"{training.accuracy:.2f}" for training in results.trainings)
        return f"The exams of the trainings: {shares}."
    if check == "honest":
        worst = max(results.trainings, key=lambda training: training.claimed - training.accuracy)
        tested = sum(count.episodes for count in worst.tests[-1].counts.values()) if worst.tests else 0
        return (
            f"Training {worst.number} claimed {worst.claimed:.2f} by a test of {tested} episodes; the exam, of "
            f"{sum(count.episodes for count in worst.exam.values())}, found {worst.accuracy:.2f}."
        )
    return ""


def _explain_what_is_left(results: TrainingResults) -> str:
    """Says what the newest policies do in each case, and what in the settings may have undone the rest."""
    settings, cases = results.settings, results.budget.cases
    shares = ", ".join(f"{case} {results.last_tests(case).share:.2f}" for case in cases)
    left = f"The last tests of all trainings: {shares}."
    if settings.order is CaseOrder.APART:
        return f"{left} What is trained on last must not push out what was learned before."
    if settings.learning_rate.final > RESTLESS_RATE:
        return f"{left} At the end the learning rate is still {settings.learning_rate.final:g}: every step moves a value far."
    return left


def _read_settings(section: Section, budget: TrainingBudget) -> TrainingSettings:
    known = budget.cases
    train_on = section.texts("train_on", known, at_least=1)
    for each in train_on:
        if each not in known:
            section.error(f"no case {quoted(each)}: {suggestion(each, known)}", "train_on")
    steps = section.integer("steps", budget.steps, minimum=1_000, maximum=budget.steps)
    batch = section.integer("batch", minimum=max(500, -(-steps // MAX_TESTS)))
    edges = section.numbers("edges", (0.2,), at_least=1, at_most=MAX_EDGES)
    if list(edges) != sorted(set(edges)) or not all(0 < edge < 1 for edge in edges):
        section.error(f"{quoted('edges')} must rise, each between 0 and 1", "edges")
    algorithm = section.text("algorithm", budget.algorithms[0], choices=budget.algorithms)
    settings = TrainingSettings(
        algorithm=algorithm,
        learning_rate=_read_schedule(section, "learning_rate", (0.2, 0.02)),
        exploration=_read_schedule(section, "exploration", (0.3, 0.02)),
        discount=section.number("discount", 0.99, minimum=0, maximum=1),
        edges=edges,
        worlds=section.integer("worlds", 16, minimum=1, maximum=MAX_WORLDS),
        train_on=tuple(dict.fromkeys(each for each in train_on if each in known)) or known,
        order=section.choice("order", {each.value: each for each in CaseOrder}, CaseOrder.MIXED.value),
        batch=batch,
        test_episodes=section.integer("test_episodes", 20, minimum=2, maximum=MAX_TEST_EPISODES),
        stop=section.choice("stop", {each.value: each for each in StopRule}, StopRule.NEVER.value),
        goal=section.number("goal", 0.8, above=0, maximum=1),
        keeps_best=section.choice("keep", {"best": True, "newest": False}, "newest"),
        steps=steps,
    )
    if algorithm in ALGORITHMS and ALGORITHMS[algorithm].needs_torch and settings.order is CaseOrder.APART:
        section.error("one case after the other is for tables only", "order")
    return settings


def _read_schedule(section: Section, key: str, default: tuple[float, float]) -> LinearSchedule:
    """Reads a schedule: two numbers between 0 and 1, for the beginning and the end."""
    first, last = section.numbers(key, default, length=2)
    if not (0 <= first <= 1 and 0 <= last <= 1):
        section.error(f"{quoted(key)} must be two numbers between 0 and 1: at the beginning, at the end", key)
    return LinearSchedule(first, last)


CHECKS: Final[Mapping[str, Check]] = MappingProxyType(
    {each.name: each for each in (succeeds, every_case, remembers, reliable, honest, steps_used)}
)
KIND: Final = SubmissionKind(
    (".yaml", ".yml"),
    CHECKS,
    read_settings,
    collect_once(collect_evidence, runs_program=False),
    sheet_keys=SHEET_KEYS,
    exercise="12-training-strategies/forget",
)
