"""Every check of a world, by name, and what there is to say of one that is lost."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Any, Final

from grader.checks import world_contents as contents
from grader.checks import world_layers as layers
from grader.checks import world_models as models
from grader.checks import world_runs as runs
from grader.checks.contract import Check
from grader.checks.faults import Faults, RunFaults, WorldContents, WorldRun


def explain(found: WorldContents | WorldRun, name: str, params: Any) -> str:
    """What is wrong with a world in the light of a check, in words that help to mend it."""
    problems = found.world.problems
    if name == "loads":
        return "\n".join(problems if len(problems) == 1 else number_problems(problems))
    if problems:
        return "The world cannot be read yet."
    if isinstance(found, WorldRun):
        return found.run.problem or join_faults(RUNS[name](found, params))
    return join_faults(FAULTS[name](found.world, params)) if name in FAULTS else ""


def number_problems(problems: Sequence[str]) -> Iterator[str]:
    """Each with its number, so that they can be told apart in one paragraph too."""
    return (f"({number}) {problem}" for number, problem in enumerate(problems, 1))


def join_faults(faults: Iterable[str]) -> str:
    """The faults in one sentence, of many only the first."""
    some = tuple(faults)
    more = f"; and {len(some) - MOST_TOLD} more" if len(some) > MOST_TOLD else ""
    said = "; ".join(some[:MOST_TOLD]) + more
    return said if not said or said[-1] in ".?" else f"{said}."


MOST_TOLD: Final = 4
"""Faults of one check."""


def nothing_more(run: WorldRun, params: Any) -> Iterator[str]:
    """For a check whose own sentence says all."""
    return iter(())


FAULTS: Final[Mapping[str, Faults]] = MappingProxyType(
    {
        "has": contents.missing,
        "walls": contents.wrong_walls,
        "stands": contents.wrong_stand,
        "body": models.wrong_body,
        "joint": models.wrong_joint,
        "publishes": models.wrong_topics(True),
        "subscribes": models.wrong_topics(False),
        "laser": models.wrong_laser,
        "collisions": layers.wrong_contacts,
        "sights": layers.wrong_sights,
        "few_layers": layers.names,
    }
)
"""What a world's checks count, by name: each fault in words."""

RUNS: Final[Mapping[str, RunFaults]] = MappingProxyType(
    {
        "rate": runs.wrong_rate,
        "noise": runs.wrong_noise,
        "drives": runs.not_there,
        "bumps": nothing_more,
        "stopped": nothing_more,
        "reachable": runs.no_way,
        "closed": runs.leaks,
        "together": runs.apart,
    }
)
"""The same for the checks that need a run."""

CHECKS: Final[Mapping[str, Check]] = MappingProxyType(
    {
        each.name: each
        for each in (
            *(contents.loads, contents.has, contents.walls, contents.stands),
            *(models.body, models.joint, models.publishes, models.subscribes, models.laser),
            *(layers.collisions, layers.sights, layers.few_layers),
            *(runs.rate, runs.noise, runs.drives, runs.bumps, runs.stopped),
            *(runs.reachable, runs.closed, runs.together),
        )
    }
)
"""Every check of a world, by name."""
