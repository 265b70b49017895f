"""A Flatland world, in a folder with its main file: read strictly, inspected, and run with a driver of the assignment's.

A world holds no program, but it is read and run in a process of its own, which is ended when the world is too large or too
slow. ``trials`` in the assignment are runs of it, for the checks that need one::

    trials:
      - {name: hall, driver: driver.py, target: [3, 1], time: 20, seeds: [1]}

``driver`` is a node file beside the assignment or a controller of the kit; without one nothing drives.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Final, Self

from grader.assignment import Assignment, Criterion, Shift, Trial
from grader.evidence.contract import (
    EpisodeCollector,
    EpisodeSpec,
    Evidence,
    EvidenceCollector,
    EvidenceOptions,
    EvidenceRecord,
)
from grader.kinds.contract import AssignmentFiles, KindSettings, SubmissionKind
from grader.kinds.world.checks import CHECKS, NAMES_NEEDING_RUN, explain
from grader.kinds.world.facts import RunFacts, WorldFacts, WorldRunSpec
from grader.kinds.world.faults import WorldContents, WorldRun
from grader.kinds.world.sheet_keys import SHEET_KEYS
from grader.kinds.world.world_process import READ_TIMEOUT_S, WorldProcess
from grader.seeds import read_seeds
from kit.controllers import find_controller
from kit.host.failure import StudentCodeError
from kit.host.sandbox.sandbox_config import Level
from kit.plain_files import is_file_there
from kit.plain_text import quoted
from kit.run.scenario import Scenario
from kit.world.records import World
from kit.world.yaml_section import Section

MAX_RUN_S: Final = 120.0
"""Simulated seconds."""
UNKNOWN_SCENARIO: Final = Scenario("what was handed in", "", World(Path("world.yaml")), None)
"""Placeholder for the scenario of a trial, which is known only once a world is submitted."""


@dataclass(frozen=True, slots=True)
class WorldRunSpecs:
    """The run to make for each trial, except its seed."""

    specs: dict[str, WorldRunSpec] = field(default_factory=dict)


def read_settings(files: AssignmentFiles) -> KindSettings:
    """Reads the runs."""
    hidden = None if files.secret is None else files.secret.section("seeds", None)
    trials, plans = [], WorldRunSpecs()
    for each in files.public.sections("trials", ()):
        spec = _read_spec(each, files.folder)
        seeds = read_seeds(each, "seeds", (1,))
        each.finish()
        if spec.name in plans.specs:
            each.error(f"a trial named {quoted(spec.name)} already exists", "name")
        secret = read_seeds(hidden, spec.name, ()) if hidden is not None and spec.name else ()
        plans.specs[spec.name] = spec
        trials.append(
            Trial(
                spec.name,
                UNKNOWN_SCENARIO,
                spec.time_s,
                seeds,
                secret,
                Shift(),
                None,
                spec.until_reached,
                frozenset(),
            )
        )
    if hidden is not None:
        hidden.finish()
    return KindSettings(trials=tuple(trials), task=plans)


def _read_spec(section: Section, folder: Path) -> WorldRunSpec:
    driver = section.text("driver", "")
    file = ""
    if driver:
        try:
            driver_file = folder / driver
            file = str(driver_file if is_file_there(driver_file) else find_controller(driver).file)
        except LookupError as error:
            section.error(str(error), "driver")
    target = section.point("target") if section.has("target") else None
    return WorldRunSpec(
        name=section.name("name"),
        seed=0,
        time_s=section.number("time", 10.0, above=0, maximum=MAX_RUN_S),
        driver=file,
        robot=section.text("robot", ""),
        target=target,
        radius=section.number("target_radius", 0.2, above=0),
        until_reached=section.flag("until_reached", True),
    )


class WorldCollector:
    """Reads a world when a criterion first needs it, and makes each run when a criterion first needs that run."""

    def __init__(self, assignment: Assignment, file: Path, options: EvidenceOptions) -> None:
        self.level = Level(options.level)
        self._assignment = assignment
        self._file = file
        self._clock = options.clock
        self._process: WorldProcess | None = None
        self._read: EvidenceRecord | None = None
        driven = [each for each in assignment.criteria if each.check in NAMES_NEEDING_RUN]
        self._runs = EpisodeCollector(assignment, options, self._run, driven)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        if self._process is not None:
            self._process.close()

    def evidence(self, criterion: Criterion) -> Sequence[Evidence]:
        first = self._read_contents()
        contents: WorldContents | None = first.content
        if criterion.check not in NAMES_NEEDING_RUN or contents is None or contents.world.problems:
            return [first]
        return self._runs.evidence(criterion)

    def public_evidence(self, criterion: Criterion) -> Sequence[Evidence]:
        first = self._read_contents()
        contents: WorldContents | None = first.content
        if criterion.check not in NAMES_NEEDING_RUN or contents is None or contents.world.problems:
            return [first]
        return self._runs.public_evidence(criterion)

    def collected(self) -> Sequence[Evidence]:
        return [*([] if self._read is None else [self._read]), *self._runs.collected()]

    def counterparts(self, criterion: Criterion) -> Iterator[Evidence]:
        return self._runs.counterparts(criterion) if criterion.check in NAMES_NEEDING_RUN else iter(())

    def _read_contents(self) -> EvidenceRecord:
        if self._read is None:
            try:
                self._read = _record(
                    WorldContents(
                        self._running_process().read_world(min(READ_TIMEOUT_S, self._clock.left_s))
                    ),
                    "what you handed in",
                )
            except StudentCodeError as error:
                self._read = EvidenceRecord(failure=self._clock.explain(error.failure))
        return self._read

    def _run(self, spec: EpisodeSpec) -> EvidenceRecord:
        run_spec = replace(self._assignment.task.specs[spec.trial.name], seed=spec.seed)
        limit_s = min(self._assignment.limits.total_s or 120.0, self._clock.left_s)
        try:
            contents = self._read_contents().content
            facts = self._running_process().run(run_spec, limit_s)
            record = _record(WorldRun(contents.world, facts, run_spec.target is not None), spec.label)
            record.steps = round(facts.seconds / 0.01)
        except StudentCodeError as error:
            self._process = None  # it has ended
            record = EvidenceRecord(failure=self._clock.explain(error.failure), label=spec.label)
        record.secret = spec.secret
        return record

    def _running_process(self) -> WorldProcess:
        """Returns the running process; starts another, and reads the world, where the last one was ended."""
        if self._process is None:
            drivers = [each.driver for each in self._assignment.task.specs.values()]
            self._process = WorldProcess(self._file, level=self.level, drivers=drivers)
            if self._read is not None:
                self._process.read_world(min(READ_TIMEOUT_S, self._clock.left_s))
        return self._process


def _record(found: WorldContents | WorldRun, label: str) -> EvidenceRecord:
    facts: WorldFacts | RunFacts = found.run if isinstance(found, WorldRun) else found.world
    return EvidenceRecord(
        found,
        label=label,
        outcome=found.outcome,
        explain_with=partial(explain, found),
        draw_with=lambda check: facts.picture,
    )


def collect(
    assignment: Assignment, file: Path, options: EvidenceOptions
) -> AbstractContextManager[EvidenceCollector]:
    """Reads and runs the world."""
    return WorldCollector(assignment, file, options)


KIND: Final = SubmissionKind((".yaml", ".yml"), CHECKS, read_settings, collect, sheet_keys=SHEET_KEYS)
