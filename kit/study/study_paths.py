"""The ways that agents and controllers drive in the cases of a printed figure: chosen, recorded, drawn."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

import numpy as np

from kit.document.blocks import ScenePlot
from kit.learning.environment.episode_stats import EpisodeOutcome
from kit.learning.policies.episode_paths import EpisodePath, record_paths
from kit.learning.policies.paths_picture import build_paths_scene
from kit.learning.policies.policy import Policy
from kit.learning.tasks.catalogue import find_task
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.training.run_config import RunError
from kit.render.scene import Scene
from kit.study.pairs import SAMPLE_S, PairRunResult
from kit.study.printed_tables import (
    POTENTIAL_FIELDS,
    PrintedFigure,
    PrintedTable,
    printed_table,
)
from kit.study.recorded_results import RecordedPath, RecordedResult
from kit.study.study_report import paths_title

PATH_INTERVAL_S: Final = 0.5
"""Between two places of a way that is kept."""
DRIVEN_EPISODES: Final = 20
"""Episodes per case, from which the recorded ones are chosen."""


def agent_paths(
    figure: PrintedFigure, policy: Policy, task: LearningTask, seed: int, episodes_seed: int
) -> tuple[RecordedPath, ...]:
    """The ways of a trained agent in each case of a figure: the first that reached the target and the first that did not,
    where there are both; then the next ones. PolicyError if the policy does not fit the task.
    """
    ways = record_paths(policy, task, DRIVEN_EPISODES, episodes_seed)
    found: list[RecordedPath] = []
    for _, case in figure.paths:
        chosen = _one_of_each([way for way in ways if way.case == case])
        found += [_thin_path(figure.group, seed, way) for way in chosen[: figure.episodes]]
    return tuple(found)


def _one_of_each(ways: list[EpisodePath]) -> list[EpisodePath]:
    """Sorts paths: the first success and the first failure come first."""
    firsts: dict[bool, EpisodePath] = {}
    for way in ways:
        firsts.setdefault(way.outcome is EpisodeOutcome.REACHED, way)
    first = [firsts[reached] for reached in (True, False) if reached in firsts]
    return [*first, *(way for way in ways if all(way is not each for each in first))]


def controller_path(case: str, target: tuple[float, float], outcome: PairRunResult) -> RecordedPath:
    """The way of a run by potential fields. RunError if nothing was driven."""
    if not outcome.poses:
        raise RunError(f"{case}: {outcome.why or 'nothing was driven'} The same command goes on.")
    ended = {"reached": EpisodeOutcome.REACHED, "collided": EpisodeOutcome.COLLIDED}
    way = EpisodePath(
        case, ended.get(outcome.end, EpisodeOutcome.TIMED_OUT), np.array(outcome.poses), target, SAMPLE_S
    )
    return _thin_path(POTENTIAL_FIELDS, 0, way)


def _thin_path(group: str, seed: int, way: EpisodePath) -> RecordedPath:
    """A way with fewer places, to the centimetre."""
    every = max(1, round(PATH_INTERVAL_S / way.interval))
    kept = way.poses[::every, :, :2]
    if (len(way.poses) - 1) % every:
        kept = np.concatenate((kept, way.poses[-1:, :, :2]))
    places = tuple(
        tuple((round(x, 2), round(y, 2)) for x, y in kept[:, robot].tolist())
        for robot in range(kept.shape[1])
    )
    x, y = way.target
    return RecordedPath(
        group,
        seed,
        way.case,
        way.outcome.value,
        (round(x, 2), round(y, 2)),
        round(every * way.interval, 3),
        places,
    )


def path_plots(figure: PrintedFigure, recorded: RecordedResult | None) -> tuple[ScenePlot, ...]:
    """The picture of each case of a figure whose ways have been recorded."""
    table = printed_table(figure.results_of)
    found = []
    for _, case in figure.paths if recorded is not None else ():
        assert recorded is not None
        ways = recorded.paths_of(figure.group, case)
        if ways:
            name = f"figure-{figure.id.replace('.', '-')}-{case.replace('_', '-')}"
            found.append(ScenePlot(name, paths_title(figure, case, ways), _scene(table, case, ways)))
    return tuple(found)


def _scene(table: PrintedTable, case: str, ways: tuple[RecordedPath, ...]) -> Scene:
    task = find_task(table.repeat_task)
    card, task_case = next(each for each in task.map_cases() if each[1].name == case)
    return build_paths_scene(task, card, task_case, tuple(map(_episode_path, ways)))


def _episode_path(way: RecordedPath) -> EpisodePath:
    """Converts a recorded path to an episode's; headings, which are not kept, are 0."""
    places = np.array(way.places).transpose(1, 0, 2)
    poses = np.concatenate((places, np.zeros((*places.shape[:2], 1))), axis=2)
    return EpisodePath(way.case, EpisodeOutcome(way.outcome), poses, way.target, way.interval)


def missing_paths(
    figures: Iterable[PrintedFigure], recorded: RecordedResult | None
) -> tuple[PrintedFigure, ...]:
    """The figures of which a case has no recorded way."""
    return tuple(
        figure
        for figure in figures
        if recorded is None or not all(recorded.paths_of(figure.group, case) for _, case in figure.paths)
    )
