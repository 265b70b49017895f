"""What trainings for a printed table came to, as an event log of a few kB."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from statistics import fmean, pstdev
from typing import Final, NamedTuple

from kit.learning.policies.confidence_intervals import ConfidenceInterval, wilson_interval
from kit.learning.tasks.catalogue import find_task
from kit.learning.training.algorithms import find_algorithm
from kit.learning.training.presets import find_preset
from kit.learning.training.run_config import PresetName
from kit.school.report.inference import t_quantile
from kit.study.printed_tables import (
    ADJACENCY,
    ADJACENCY_BY_POSES,
    STEPS,
    SUCCESS,
    PrintedTable,
)
from kit.study.study_variants import StudyVariant


class RecordedResultError(Exception):
    """A log that cannot be read; the message names the file and the line."""


@dataclass(frozen=True, slots=True)
class RecordedSettings:
    """How all agents of a log were trained and tested."""

    table: str
    task: str
    algorithm: str
    preset: str
    episodes: int
    """Episodes per case."""
    steps: int | None
    """Most steps of each training; None: the preset's."""
    versions: Mapping[str, str]
    """Versions of packages, Python and the machine."""
    command: str = ""
    """That made the log."""
    commit: str = ""
    """Commit of the kit; empty if it was installed from a package."""
    changed: str = ""
    """Settings of the algorithm that differ from the preset's, as ``--set`` takes them."""

    @property
    def most_steps(self) -> int:
        """Most steps of each training."""
        if self.steps is not None:
            return self.steps
        preset: PresetName = self.preset  # type: ignore[assignment]  # a log of another kit's: refused below
        return find_preset(preset, find_algorithm(self.algorithm), find_task(self.task).preset).steps


class TrainingSession(NamedTuple):
    """A test during training, on fresh episodes of the cases trained on."""

    steps: int
    reached: int
    collided: int
    timed_out: int
    reward: float | None
    """Mean sum over an episode."""
    adjacency: float | None
    """Mean share of steps side by side; None for one robot."""
    value_max: float | None = None
    """The largest value of the observations before the test; None where the learner has none."""

    @property
    def share(self) -> float:
        """The share of the episodes that reached the target."""
        return self.reached / max(1, self.reached + self.collided + self.timed_out)


class SideShare(NamedTuple):
    """The share of an episode's steps in which two robots were side by side."""

    mean: float
    sd: float
    """Sample standard deviation over the episodes; NaN if unknown."""
    episodes: int


@dataclass(frozen=True, slots=True)
class RecordedTest:
    """One agent's test on all cases; or a controller's runs of some."""

    group: str
    """The cases that it was trained on; or the controller."""
    seed: int
    steps: int
    seconds: float
    """That its training took."""
    episodes: int
    """Episodes per case."""
    reached: Mapping[str, int]
    """Episodes that reached the target, by case."""
    adjacency: Mapping[str, float]
    """Share of steps in which two robots were side by side by their rays, by case, over all episodes. Empty for one robot."""
    own_cases: tuple[str, ...] = ()
    """The names of the cases that it was trained on."""
    sessions: tuple[TrainingSession, ...] = ()
    """Sessions in order."""
    adjacency_sd: Mapping[str, float] = field(default_factory=dict)
    """Sample standard deviation of that share over the episodes, by case."""
    by_poses: Mapping[str, float] = field(default_factory=dict)
    """Share of the time in which a controller's two robots were side by side by their poses, by case, over all runs."""
    reached_by_rays: Mapping[str, float] = field(default_factory=dict)
    """The share by rays over the episodes that reached the target alone, by case."""
    reached_by_rays_sd: Mapping[str, float] = field(default_factory=dict)
    """Its sample standard deviation over those episodes."""
    reached_by_poses: Mapping[str, float] = field(default_factory=dict)
    """The share by poses over the episodes that reached the target alone, by case."""

    @property
    def best_session(self) -> TrainingSession | None:
        """The test during training in which most episodes reached the target, the first of several; None without tests."""
        return max(self.sessions, key=lambda session: session.share, default=None)

    @property
    def largest_value(self) -> float | None:
        """The largest value of all tests during training; None where the learner has no values."""
        known = [session.value_max for session in self.sessions if session.value_max is not None]
        return max(known, default=None)

    def side_share(self, case: str, measure: str) -> SideShare | None:
        """How long two robots were side by side in the episodes of a case that reached the target, by a measure of adjacency.
        None if none did, or if it was recorded of all episodes together and some of them did not."""
        reached = self.reached.get(case, 0)
        of_all = self.adjacency if measure == ADJACENCY else self.by_poses
        of_reached = self.reached_by_rays if measure == ADJACENCY else self.reached_by_poses
        if not reached:
            return None
        if case in of_reached:
            sd = self.reached_by_rays_sd.get(case, math.nan) if measure == ADJACENCY else math.nan
            return SideShare(of_reached[case], sd, reached)
        if case in of_all and reached == self.episodes:
            sd = self.adjacency_sd.get(case, math.nan) if measure == ADJACENCY else math.nan
            return SideShare(of_all[case], sd, reached)
        return None


@dataclass(frozen=True, slots=True)
class RecordedPath:
    """One episode's way, as it is drawn."""

    group: str
    """The cases that the agent was trained on; or the controller."""
    seed: int
    case: str
    outcome: str
    """One of ``OUTCOMES``."""
    target: tuple[float, float]
    interval: float
    """Between two places [s]."""
    places: tuple[tuple[tuple[float, float], ...], ...]
    """For each robot: where it was [m], from the start on; the last is where the episode ended."""


OUTCOMES: Final = ("reached", "collided", "timed out")
"""The values of ``kit.learning.environment.episode_stats.EpisodeOutcome``, which the kernels come with."""
Event = RecordedSettings | RecordedTest | RecordedPath


@dataclass(frozen=True, slots=True)
class RecordedCell:
    """A number that stands against a printed one."""

    value: float
    interval: ConfidenceInterval | None
    """The 95 % interval over episodes: Wilson's of a share of successes, Student's of a mean adjacency; None for others."""
    measure: str = SUCCESS
    episodes: int | None = None
    """Of an adjacency: over how many episodes, all of which reached the target."""


@dataclass(frozen=True, slots=True)
class RecordedResult:
    """A log that has been read."""

    file: Path
    settings: RecordedSettings
    tests: tuple[RecordedTest, ...]
    paths: tuple[RecordedPath, ...] = ()

    def paths_of(self, group: str, case: str) -> tuple[RecordedPath, ...]:
        return tuple(each for each in self.paths if (each.group, each.case) == (group, case))

    def has_test(self, group: str, seed: int) -> bool:
        return any((each.group, each.seed) == (group, seed) for each in self.tests)

    def tests_of(self, group: str) -> tuple[RecordedTest, ...]:
        return tuple(each for each in self.tests if each.group == group)

    @property
    def rate(self) -> float | None:
        """Steps per second of training, of all agents together; None if none was timed."""
        seconds = sum(each.seconds for each in self.tests)
        return sum(each.steps for each in self.tests) / seconds if seconds else None

    def cells(self, table: PrintedTable) -> dict[tuple[str, str], RecordedCell]:
        """The numbers that stand against those of ``table``, by row and column: cases, and the rows mean and SD.

        None do against the best test of one training: see ``TrainedSeeds``.
        """
        if table.prints_best_test:
            return {}
        return self._case_cells(table) if table.cases else self._training_cells(table)

    def _case_cells(self, table: PrintedTable) -> dict[tuple[str, str], RecordedCell]:
        """Returns the cells of a table whose rows are cases and whose columns are agents."""
        found: dict[tuple[str, str], RecordedCell] = {}
        for column, group, measure in zip(table.columns, table.groups, table.measures, strict=True):
            tests = self.tests_of(group)
            own = {}
            for row, (_, case) in zip(table.rows, table.cases, strict=False):
                if (cell := pooled_cell(tests, measure, [case])) is not None:
                    own[row] = cell
            if len(own) == len(table.cases):
                own |= _mean_and_spread(list(own.values()))
            found |= {(row, column): cell for row, cell in own.items() if row in table.rows}
        return found

    def _training_cells(self, table: PrintedTable) -> dict[tuple[str, str], RecordedCell]:
        """Computes the cells of a table whose rows are trainings: their steps, and how their agents do on fresh episodes of their own cases."""
        found: dict[tuple[str, str], RecordedCell] = {}
        for place, column in enumerate(table.columns if table.measures else ()):
            own = {}
            for number, row in enumerate(table.rows):
                group = table.training_group(number, place)
                tests = self.tests_of(group) if group else ()
                if table.seed_rows:
                    tests = tuple(each for each in tests if each.seed == number)
                if (cell := pooled_cell(tests, table.measures[place])) is not None:
                    own[row] = cell
            if table.seed_rows and own and len(own) == table.attempts:
                own |= {"mean": _mean_and_spread(list(own.values()))["mean"]}
            found |= {(row, column): cell for row, cell in own.items() if row in table.rows}
        return found


def _mean_and_spread(cells: list[RecordedCell]) -> dict[str, RecordedCell]:
    values, measure = [cell.value for cell in cells], cells[0].measure
    return {
        "mean": RecordedCell(fmean(values), None, measure),
        "SD": RecordedCell(pstdev(values), None, measure),
    }


def pooled_cell(
    tests: Sequence[RecordedTest], measure: str, cases: list[str] | None = None
) -> RecordedCell | None:
    """Returns the cell of all seeds together, on ``cases`` or those that each was trained on; None if it was not
    measured, or is the adjacency of agents that never reached the target: those that crash a few steps after the start are side
    by side only because they began so."""
    if measure == STEPS:
        return RecordedCell(fmean(each.steps for each in tests), None, measure) if tests else None
    pairs = [(each, case) for each in tests for case in (each.own_cases if cases is None else cases)]
    if measure in (ADJACENCY, ADJACENCY_BY_POSES):
        return _adjacency_cell([test.side_share(case, measure) for test, case in pairs], measure)
    tested = [(test, case) for test, case in pairs if case in test.reached]
    episodes = sum(test.episodes for test, _ in tested)
    if not episodes:
        return None
    assert measure == SUCCESS
    reached = sum(test.reached[case] for test, case in tested)
    return RecordedCell(reached / episodes, wilson_interval(reached, episodes), measure)


def _adjacency_cell(told: list[SideShare | None], measure: str) -> RecordedCell | None:
    """The mean over the episodes of all cases and seeds that reached the target; its interval where each tells how its episodes
    differ."""
    known = [each for each in told if each is not None]
    episodes = sum(each.episodes for each in known)
    if not episodes:
        return None
    mean = sum(each.mean * each.episodes for each in known) / episodes
    if any(math.isnan(each.sd) for each in known) or episodes <= len(known):
        return RecordedCell(mean, None, measure, episodes)
    error = math.sqrt(sum(each.sd**2 * each.episodes for each in known)) / episodes
    half = t_quantile(0.975, episodes - len(known)) * error
    interval = ConfidenceInterval(max(0.0, mean - half), min(1.0, mean + half))
    return RecordedCell(mean, interval, measure, episodes)


Results = Mapping[StudyVariant, RecordedResult]
"""Those that there are."""
