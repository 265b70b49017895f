"""The record of a task to learn: maps, robots, what agents see and do, what it earns, where episodes start, and how they end."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

import numpy as np

from kit.learning.tasks.actions import Actions
from kit.learning.tasks.curriculum import Curriculum
from kit.learning.tasks.disturbances import UNDISTURBED, Disturbances
from kit.learning.tasks.goals.goal import Goal
from kit.learning.tasks.goals.target import REACH_TARGET
from kit.learning.tasks.observations import ObservationSpec
from kit.learning.tasks.reward import Reward
from kit.learning.tasks.task_case import TaskCase
from kit.learning.tasks.transition import Array, Transition
from kit.plain_text import quoted, suggestion
from kit.world.catalogue import MapCard, find_map

PRESET_NAMES = ("turn", "hallway", "wheelchairs", "continuous")
"""What the kit's presets were made for."""
Ending = Literal["terminated", "truncated", "continues"]
"""What an event means for learning: the world has ended, it was cut short, or the episode goes on."""


class UnknownTask(LookupError):
    """No task, or no case of a task, has that name; the message offers the nearest one."""


@dataclass(frozen=True, slots=True)
class StartVariation:
    """Random variation of an episode's start and target around those of its case. Every draw is uniform."""

    shifted: bool = True
    """Whether start and target are shifted, and headings any, as the case allows."""
    noise: float = 0.0
    """m: up to this much along x and y, for every robot by itself."""
    max_rotation: float = 0.0
    """rad: up to this much to either side, likewise."""
    gap: float | None = None
    """m between two robots; None: as in the case."""


@dataclass(frozen=True, slots=True, repr=False)
class LearningTask:
    """A task to learn: maps, observations, actions, reward, goal and end conditions."""

    name: str
    summary: str
    maps: tuple[str, ...]
    """Maps of the catalogue; all with the same robots and laser beams. Empty where the task has worlds of its own."""
    robots: int
    actions: Actions
    observation: ObservationSpec
    reward: Reward
    cases: tuple[str, ...] = ()
    """Names of cases; all of them where empty."""
    step_time: float = 0.2
    """s"""
    collision_checks: int = 2
    """Into how many equal moves a step is divided; after each one, collisions are looked for."""
    stops_between: bool = False
    """Whether a robot stops at the end of each step until its next command takes effect, if that is late; else the last one
    goes on."""
    max_steps: int = 200
    start: StartVariation = StartVariation()
    target_radius: float = 0.25
    """m"""
    measured_to: Literal["hull", "axle"] = "hull"
    """How near the target a robot is: by the nearest point of its hull, as the seed's beacon measures it, or by
    the middle of its axle, which is harder."""
    lidar_noise: float | None = None
    """m, standard deviation on every range; None: as the robots' files say."""
    disturbances: Disturbances = UNDISTURBED
    """What differs from the robots' files, drawn again for every episode."""
    path_end: float = 0.0
    """m: ``Transition.to_go`` does not fall below this."""
    timeout_terminal: bool = False
    """Whether running out of time ends an episode as if that were the world's doing. It is wrong (the agent cannot
    see the clock), and what the seed does; kept so that its harm can be shown."""
    collision_ending: Ending = "terminated"
    """Where the episode goes on, a robot that meets something only stays where it is."""
    goal_ending: Literal["terminated", "truncated"] = "terminated"
    goal: Goal = REACH_TARGET
    cards: tuple[MapCard, ...] = ()
    """Worlds of the task's own."""
    own_cases: tuple[tuple[int, TaskCase], ...] = ()
    """Cases of the task's own, each with the number of its map; empty: those of the maps' cards."""
    robot_names: tuple[str, ...] = ()
    """Models that drive; empty: those of the maps' cards."""
    random_phase: bool = True
    """Whether moving models begin an episode anywhere on their way; else as in their files."""
    preset: str = ""
    """The kit's preset for this task, by the name of a task that it was made for; empty: the algorithm's usual one."""
    success: float | None = None
    """Training may stop when this share of the episodes surely succeeds; None: as the preset says."""
    curriculum: Curriculum = ()
    """Which cases training begins with; empty: all of them at once."""
    reward_file: Path | None = None
    """A Python file with a reward of the task's own, used in training; ``reward`` is then for tests."""
    file: Path | None = None
    """The task's file."""
    version: str = ""
    """The first 12 digits of the SHA-256 of the file's text."""

    def __repr__(self) -> str:
        """``LearningTask(turn: Round one corner and back again)``"""
        return f"LearningTask({self.name}: {self.summary})"

    def endings(self, transition: Transition) -> tuple[Array, Array]:
        """(...) bool each: which episodes have terminated, and which were truncated."""
        reached, crashed, late = transition.reached, transition.crashed, transition.timed_out
        if self.goal_ending == self.collision_ending == "terminated" and not self.timeout_terminal:
            return crashed | reached, late
        terminated = np.zeros_like(reached)
        for event, ending in (
            (reached, self.goal_ending),
            (crashed, self.collision_ending),
            (late, "terminated" if self.timeout_terminal else "truncated"),
        ):
            if ending == "terminated":
                terminated = terminated | event
        return terminated, transition.ended & ~terminated

    @property
    def map_cards(self) -> tuple[MapCard, ...]:
        """The cards of the task's maps. Raises UnknownMap."""
        return self.cards or tuple(find_map(name) for name in self.maps)

    def map_cases(self) -> tuple[tuple[MapCard, TaskCase], ...]:
        """Every case with its map, in order. UnknownTask if one of ``cases`` is none of them."""
        found = tuple(self._all_cases())
        if not self.cases:
            return found
        by_name = {case.name: (card, case) for card, case in found}
        for name in self.cases:
            if name not in by_name:
                raise UnknownTask(f"task {self.name} has no case {quoted(name)}: {suggestion(name, by_name)}")
        return tuple(by_name[name] for name in self.cases)

    def route(self, case: TaskCase) -> tuple[tuple[float, float], ...]:
        """Where a route goes: the case's targets of all rounds, in their order [m, m]. Empty for a goal that has none."""
        return (
            self.goal.route(tuple((each.x, each.y) for each in case.targets.poses))
            if self.goal.is_route
            else ()
        )

    def robots_on(self, card: MapCard) -> tuple[str, ...]:
        """The models that drive on a map."""
        return self.robot_names or tuple(name for name in (card.robot, card.partner) if name)

    def on(self, *names: str) -> LearningTask:
        """This task on some of its cases, named one by one or by their groups.

        UnknownTask if nothing has such a name.
        """
        courses = self.map_cases()
        known = [name for _, case in courses for name in (case.name, case.group) if name]
        for name in names:
            if name not in known:
                raise UnknownTask(f"task {self.name} has no case {quoted(name)}: {suggestion(name, known)}")
        chosen = tuple(case.name for _, case in courses if {case.name, case.group} & set(names))
        return replace(self, cases=chosen)

    def _all_cases(self) -> Iterator[tuple[MapCard, TaskCase]]:
        cards = self.map_cards
        for number, case in self.own_cases:
            yield cards[number], case
        for card in cards if not self.own_cases else ():
            for map_case in card.cases:
                yield card, TaskCase.from_map(map_case)
