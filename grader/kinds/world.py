"""A Flatland world, in a folder with its main file: read strictly, looked at, and run with a driver of ours.

Nothing of it is a program; it is read in a process of its own all the same, which ends when the world is too large or
too slow. The sheet's ``trials`` are runs of it, for the checks that need one::

    trials:
      - {name: hall, driver: driver.py, target: [3, 1], time: 20, seeds: [1]}

``driver`` is a node file beside the sheet or a controller of the kit's; without one the world just stands.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Final, Self

from grader.assignment import Assignment, Criterion, Seeds, Shift, Trial
from grader.checks.faults import Run, Seen
from grader.checks.worlds import CHECKS, RUNS, remark
from grader.evidence.world.facts import Order, RunFacts, WorldFacts
from grader.evidence.world.process import WorldProcess
from grader.kinds.contract import Conditions, Look, Sheet, Sort, Task
from kit.controllers import find
from kit.host.failure import GuestError
from kit.host.sandbox.confinement import Level
from kit.run.scenario import Place
from kit.world.problems import quoted
from kit.world.records import World
from kit.world.yaml_section import Section

if TYPE_CHECKING:
    from contextlib import AbstractContextManager

    from grader.grading import Gatherer

LONGEST_RUN: Final = 120.0
"""Simulated seconds."""
NOWHERE: Final = Place("what was handed in", "", World(Path("world.yaml")), None)
"""Where a run takes place is known only when something was handed in."""


@dataclass(frozen=True, slots=True)
class Plans:
    """The kind's task: an order for each trial, which lacks only its seed."""

    orders: dict[str, Order] = field(default_factory=dict)


def read(sheet: Sheet) -> Task:
    """The runs."""
    hidden = None if sheet.secret is None else sheet.secret.section("seeds", None)
    trials, plans = [], Plans()
    for each in sheet.public.sections("trials", ()):
        order = _order(each, sheet.folder)
        seeds = _seeds(each, "seeds", (1,))
        each.finish()
        if order.name in plans.orders:
            each.error(f"a trial named {quoted(order.name)} already exists", "name")
        secret = _seeds(hidden, order.name, ()) if hidden is not None and order.name else ()
        plans.orders[order.name] = order
        trials.append(
            Trial(
                order.name,
                NOWHERE,
                order.time_s,
                seeds,
                secret,
                Shift(),
                None,
                order.until_reached,
                frozenset(),
            )
        )
    if hidden is not None:
        hidden.finish()
    return Task(trials=tuple(trials), content=plans)


def _order(section: Section, folder: Path) -> Order:
    driver = section.text("driver", "")
    file = ""
    if driver:
        try:
            own = folder / driver
            file = str(own if own.is_file() else find(driver).file)
        except LookupError as error:
            section.error(str(error), "driver")
    target = section.point("target") if section.has("target") else None
    return Order(
        name=section.name("name"),
        seed=0,
        time_s=section.number("time", 10.0, above=0, maximum=LONGEST_RUN),
        driver=file,
        robot=section.text("robot", ""),
        target=target,
        radius=section.number("target_radius", 0.2, above=0),
        until_reached=section.flag("until_reached", True),
    )


def _seeds(section: Section, key: str, default: tuple[int, ...]) -> tuple[int, ...]:
    numbers = section.numbers(key, default)
    if any(number != int(number) or number < 0 for number in numbers) or len(set(numbers)) < len(numbers):
        section.error(f"{quoted(key)} must be whole numbers from 0 on, each once", key)
        return default
    return tuple(map(int, numbers))


class WorldLooks:
    """One world: looked at when it is first asked for, run when a criterion first needs that run."""

    def __init__(self, assignment: Assignment, file: Path, conditions: Conditions) -> None:
        self.level = Level(conditions.level)
        self._assignment = assignment
        self._file = file
        self._secret = conditions.secret
        self._process: WorldProcess | None = None
        self._looks: dict[tuple[str, bool, int], Look] = {}
        self._read: Look | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._process is not None:
            self._process.close()

    def evidence(self, criterion: Criterion) -> Sequence[Look]:
        first = self._first()
        seen: Seen | None = first.found
        if criterion.check not in RUNS or seen is None or seen.world.problems:
            return [first]
        return [
            self._run(self._assignment.trial(name), seed, secret, place)
            for name in criterion.trials
            for seed, secret, place in self._seeds(self._assignment.trial(name), criterion.seeds)
        ]

    def all(self) -> Sequence[Look]:
        return [*([] if self._read is None else [self._read]), *self._looks.values()]

    def _seeds(self, trial: Trial, which: Seeds) -> Iterator[tuple[int, bool, int]]:
        """The seed, whether it is secret, and its place among its kind from 1."""
        if which is not Seeds.SECRET:
            yield from ((seed, False, place) for place, seed in enumerate(trial.seeds, 1))
        if which is not Seeds.PUBLIC and self._secret:
            yield from ((seed, True, place) for place, seed in enumerate(trial.secret_seeds, 1))

    def _first(self) -> Look:
        if self._read is None:
            try:
                self._read = _look(Seen(self._asked().world()), "what you handed in")
            except GuestError as error:
                self._read = Look(failure=error.failure)
        return self._read

    def _run(self, trial: Trial, seed: int, secret: bool, place: int) -> Look:
        key = trial.name, secret, seed
        if key not in self._looks:
            label = f"{trial.name}, secret seed {place}" if secret else f"{trial.name}, seed {seed}"
            order = self._assignment.task.orders[trial.name]
            order = replace(order, seed=seed)
            try:
                first = self._first().found
                facts = self._asked().run(order, self._assignment.limits.total_s or 120.0)
                look = _look(Run(first.world, facts, order.target is not None), label)
                look.steps = round(facts.seconds / 0.01)
            except GuestError as error:
                self._process = None  # it has ended
                look = Look(failure=error.failure, label=label)
            look.secret = secret
            self._looks[key] = look
        return self._looks[key]

    def _asked(self) -> WorldProcess:
        """The process; a new one where the last was ended, with its world read."""
        if self._process is None:
            self._process = WorldProcess(self._file)
            if self._read is not None:
                self._process.world()
        return self._process


def _look(found: Seen | Run, label: str) -> Look:
    facts: WorldFacts | RunFacts = found.run if isinstance(found, Run) else found.world
    return Look(
        found,
        label=label,
        outcome=found.outcome,
        remarks=partial(remark, found),
        pictures=lambda check: facts.picture,
    )


def gather(assignment: Assignment, file: Path, conditions: Conditions) -> AbstractContextManager[Gatherer]:
    """Looks at the world, once for all criteria."""
    return WorldLooks(assignment, file, conditions)


SORT: Final = Sort((".yaml", ".yml"), CHECKS, read, gather)
