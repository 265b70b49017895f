"""The settings of a training, in a YAML file: trained over several seeds, and judged by what the kept policy can do.

The sheet says what is to be learned and what it may cost::

    training:
      task: turn
      reward: progress
      scale: 1.0
      algorithms: [q-learning, sarsa]
      steps: 150000            # of each training, at most
      seeds: [1, 2, 3]         # a training each; others may stand in secret.yaml
      episodes: 200            # of each case, in the exam after each training
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Final

from grader.assignment import Assignment
from grader.checks.contract import Check, check
from grader.evidence.training import Budget, Order, Plan, Stop, Trainings, train
from grader.kinds.contract import Conditions, Look, Sheet, Sort, Task, from_yaml, once
from kit.host.failure import Failure, FailureKind
from kit.host.wire import printable
from kit.learning.environment.task_spec import TaskChoice
from kit.learning.environment.tasks import UnknownTask
from kit.learning.training.algorithms import ALGORITHMS
from kit.learning.training.optional_deps import LearnerMissing
from kit.learning.training.presets import Falling
from kit.world.problems import quoted, suggestion
from kit.world.yaml_section import Section

MOST_STEPS: Final = 5_000_000
MOST_SEEDS: Final = 20
MOST_WORLDS: Final = 256
MOST_TESTED: Final = 2_000
MOST_LOOKS: Final = 100
"""Tests of one training: more would take longer than the training."""
MOST_EDGES: Final = 4
TABLES: Final = ("q-learning", "sarsa")


@dataclass(frozen=True, slots=True)
class Reliable:
    """What a single training must reach to count."""

    goal: float = 0.9


@check(none=0.5, full=0.9, unit="%")
def succeeds(look: Look, params: object) -> float:
    """After these trainings the robot surely reaches its target in {actual} of the episodes; {full} earns all points.
    (“Surely”: the lower end of Wilson's interval, all exams together.)"""
    seen: Trainings = look.found
    return seen.surely()


@check(none=0.4, full=0.85, unit="%")
def every_case(look: Look, params: object) -> float:
    """In the case that goes worst the robot surely reaches its target in {actual} of the episodes; {full} earns all
    points."""
    seen: Trainings = look.found
    return seen.surely(seen.worst_case)


@check(none=0.3, full=1, unit="%", params=Reliable)
def reliable(look: Look, params: Reliable) -> float:
    """Only {actual} of the trainings led to a policy that is good enough: the others had less luck with their seed."""
    seen: Trainings = look.found
    return sum(training.accuracy >= params.goal for training in seen.each) / len(seen.each)


@check(none=0.25, full=0.08)
def honest(look: Look, params: object) -> float:
    """What a training's own last test says of its policy must be true: it promised {actual} more, as a share of
    episodes, than the exam found; {full} is allowed."""
    seen: Trainings = look.found
    return max(max(0.0, training.claimed - training.accuracy) for training in seen.each)


@check(none=1.0, full=0.7, unit="%")
def steps_used(look: Look, params: object) -> float:
    """The trainings used {actual} of the steps they might; {full} or less earns all points. When is it good enough?"""
    seen: Trainings = look.found
    return sum(training.steps for training in seen.each) / (len(seen.each) * seen.budget.steps)


def read(sheet: Sheet) -> Task:
    """What is to be learned, and what it may cost."""
    section = sheet.public.section("training")
    choice = TaskChoice(
        section.name("task"),
        reward=section.text("reward") if section.has("reward") else None,
        scale=section.number("scale", above=0) if section.has("scale") else None,
    )
    algorithms = section.texts("algorithms", TABLES, at_least=1)
    steps = section.integer("steps", minimum=1_000, maximum=MOST_STEPS)
    episodes = section.integer("episodes", 200, minimum=10, maximum=2_000)
    seeds, secret = _seeds(section), () if sheet.secret is None else _seeds(sheet.secret)
    for each in algorithms:
        if each not in ALGORITHMS:
            section.error(f"no algorithm {quoted(each)}: {suggestion(each, ALGORITHMS)}", "algorithms")
    section.finish()
    try:
        cases = tuple(case.name for _, case in choice.resolve().courses())
    except UnknownTask as error:
        section.error(str(error), "task")
        return Task()
    return Task(content=Budget(choice, cases, algorithms, steps, seeds, secret, episodes))


def _seeds(section: Section) -> tuple[int, ...]:
    numbers = section.numbers("seeds", at_least=1, at_most=MOST_SEEDS)
    if any(number != int(number) or number < 0 for number in numbers):
        section.error(f"{quoted('seeds')} must be whole numbers from 0 on", "seeds")
    return tuple(int(abs(number)) for number in numbers)


def look(assignment: Assignment, file: Path, conditions: Conditions) -> Look:
    """Trains as the file says, once for each seed."""
    budget: Budget = assignment.task
    plan = from_yaml(file, lambda section: _plan(section, budget))
    if isinstance(plan, Failure):
        return Look(failure=plan)
    try:
        seeds = budget.secret_seeds if conditions.secret and budget.secret_seeds else budget.seeds
        found = train(plan, budget, seeds)
    except LearnerMissing as error:
        return _failed(str(error))
    return Look(
        found,
        label="the trainings",
        outcome="trained",
        steps=sum(training.steps for training in found.each),
        remarks=lambda check, params: _remark(found, check),
        pictures=lambda check: found.picture(),
    )


def _failed(message: str) -> Look:
    failure = Failure(FailureKind.IMPORT, printable(message))
    return Look(failure=failure, label="the trainings", outcome="not trained")


def _remark(found: Trainings, check: str) -> str:
    """Which training or case it is about."""
    if check == "every_case":
        count = found.pooled(found.worst_case)
        return f"That is {found.worst_case}, reached {count.reached} times in {count.episodes}."
    if check in ("succeeds", "reliable"):
        shares = ", ".join(f"{training.accuracy:.2f}" for training in found.each)
        return f"The exams of the trainings: {shares}."
    if check == "honest":
        worst = max(found.each, key=lambda training: training.claimed - training.accuracy)
        tested = sum(count.episodes for count in worst.tests[-1].counts.values()) if worst.tests else 0
        return (
            f"Training {worst.number} claimed {worst.claimed:.2f} by a test of {tested} episodes; the exam, of "
            f"{sum(count.episodes for count in worst.exam.values())}, found {worst.accuracy:.2f}."
        )
    return ""


def _plan(section: Section, budget: Budget) -> Plan:
    known = budget.cases
    train_on = section.texts("train_on", known, at_least=1)
    for each in train_on:
        if each not in known:
            section.error(f"no case {quoted(each)}: {suggestion(each, known)}", "train_on")
    steps = section.integer("steps", budget.steps, minimum=1_000, maximum=budget.steps)
    batch = section.integer("batch", minimum=max(500, steps // MOST_LOOKS))
    edges = section.numbers("edges", (0.2,), at_least=1, at_most=MOST_EDGES)
    if list(edges) != sorted(set(edges)) or not all(0 < edge < 1 for edge in edges):
        section.error(f"{quoted('edges')} must rise, each between 0 and 1", "edges")
    algorithm = section.text("algorithm", budget.algorithms[0], choices=budget.algorithms)
    made = Plan(
        algorithm=algorithm,
        learning_rate=_falling(section, "learning_rate", (0.2, 0.02)),
        exploration=_falling(section, "exploration", (0.3, 0.02)),
        discount=section.number("discount", 0.99, minimum=0, maximum=1),
        edges=edges,
        worlds=section.integer("worlds", 16, minimum=1, maximum=MOST_WORLDS),
        train_on=tuple(dict.fromkeys(each for each in train_on if each in known)) or known,
        order=section.choice("order", {each.value: each for each in Order}, Order.MIXED.value),
        batch=batch,
        test_episodes=section.integer("test_episodes", 20, minimum=2, maximum=MOST_TESTED),
        stop=section.choice("stop", {each.value: each for each in Stop}, Stop.NEVER.value),
        goal=section.number("goal", 0.8, above=0, maximum=1),
        keeps_best=section.choice("keep", {"best": True, "newest": False}, "newest"),
        steps=steps,
    )
    if algorithm in ALGORITHMS and ALGORITHMS[algorithm].neural and made.order is Order.APART:
        section.error("one case after the other is for tables only", "order")
    section.finish()
    return made


def _falling(section: Section, key: str, default: tuple[float, float]) -> Falling:
    """Two numbers between 0 and 1: at the beginning, at the end."""
    first, last = section.numbers(key, default, length=2)
    if not (0 <= first <= 1 and 0 <= last <= 1):
        section.error(f"{quoted(key)} must be two numbers between 0 and 1: at the beginning, at the end", key)
    return Falling(first, last)


CHECKS: Final[Mapping[str, Check]] = MappingProxyType(
    {each.name: each for each in (succeeds, every_case, reliable, honest, steps_used)}
)
SORT: Final = Sort((".yaml", ".yml"), CHECKS, read, once(look))
