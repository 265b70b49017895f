"""The record of a task to learn: maps, robots, what agents see and do, what it earns, where episodes start, and how they end.

A goal is a count that grows until it is full: then the episode has reached it. A curriculum says which cases are practised
first, and how well before the next ones come (Bengio and others 2009).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, Literal, TypeAlias

import numpy as np

from kit.arrays import FloatArray
from kit.geometry import Pose
from kit.learning.tasks.actions import Actions
from kit.learning.tasks.disturbances import UNDISTURBED, Disturbances
from kit.learning.tasks.observations import ObservationSpec
from kit.learning.tasks.rewards import Reward
from kit.learning.tasks.transition import Array, Transition
from kit.plain_text import counted, quoted, suggestion
from kit.world.catalogue import MapCard, MapCase, find_map
from kit.world.yaml_section import Section


@dataclass(frozen=True, slots=True)
class TargetGoal:
    """Every robot is in the target at the same time."""

    heading_tolerance: float | None = None
    """The target's heading must be kept within this [rad]; None: any heading will do."""

    @property
    def description(self) -> str:
        if self.heading_tolerance is None:
            return "be in the target"
        return f"be in the target, within {self.heading_tolerance:g} rad of its heading"


@dataclass(frozen=True, slots=True)
class PatrolGoal:
    """The case's targets are reached one after the other."""

    rounds: int = 1
    """Number of rounds through all targets."""

    @property
    def description(self) -> str:
        return f"reach all targets in their order, {counted(self.rounds, 'time')}"

    def route(self, targets: tuple[tuple[float, float], ...]) -> tuple[tuple[float, float], ...]:
        """The targets of all rounds, one after the other [m, m]; ``targets``: those of one."""
        return targets * self.rounds


@dataclass(frozen=True, slots=True)
class CoverGoal:
    """A share of the floor that can be reached is driven over."""

    share: float = 0.9
    radius: float = 0.15
    """A robot covers what lies within this of its origin [m]."""

    @property
    def description(self) -> str:
        return f"come within {self.radius:g} m of {self.share:.0%} of the floor"


@dataclass(frozen=True, slots=True)
class WallGoal:
    """Every robot drives along a wall on one side of it."""

    side: Literal["left", "right"] = "right"
    distance: float = 0.25
    """From the lidar to the wall [m]."""
    tolerance: float = 0.1
    """Metres driven count where the distance is off by at most this [m]."""
    length: float = 5.0
    """Total length [m]."""

    @property
    def description(self) -> str:
        return (
            f"drive {self.length:g} m with a wall on the {self.side}, "
            f"{self.distance - self.tolerance:g} to {self.distance + self.tolerance:g} m away"
        )


@dataclass(frozen=True, slots=True)
class FollowGoal:
    """Every robot stays near a target that moves."""

    nearest: float = 0.3
    farthest: float = 0.8
    """Between these distances [m] from the target's middle time counts."""
    time: float = 20.0
    """Total time [s]."""

    @property
    def description(self) -> str:
        return f"be {self.nearest:g} to {self.farthest:g} m from the leader for {self.time:g} s in total"


@dataclass(frozen=True, slots=True)
class AvoidGoal:
    """No robot comes near a moving model."""

    distance: float = 0.4
    """Seconds count in which every moving model is farther than this from every robot's origin [m]."""
    time: float = 20.0
    """Total time [s]."""

    @property
    def description(self) -> str:
        return f"be more than {self.distance:g} m from everything that moves, for {self.time:g} s in total"


REACH_TARGET: Final = TargetGoal()
"""What most tasks ask for."""

Goal: TypeAlias = TargetGoal | PatrolGoal | CoverGoal | WallGoal | FollowGoal | AvoidGoal


Area = tuple[float, float, float, float]
"""``x1 y1 x2 y2`` [m]: an upright rectangle, by two opposite corners."""


@dataclass(frozen=True, slots=True)
class EpisodePlaces:
    """Places of which every episode takes one, each as likely as the others; poses where there are any, else an area.

    Of an area only the floor counts on which a robot of any heading touches nothing, and from which the rest of the
    task can be reached.
    """

    poses: tuple[Pose, ...] = ()
    """For targets the heading counts only where the goal asks for one."""
    area: Area | None = None
    """Its floor; None with no poses: the floor of the whole map."""
    headings: tuple[float, float] = (-math.pi, math.pi)
    """Headings in an area are drawn between these [rad]."""
    model: str | None = None
    """Targets only: the target moves with this model of the world."""

    @property
    def is_area(self) -> bool:
        """Whether places are drawn from the floor."""
        return not self.poses and self.model is None

    @property
    def nominal(self) -> Pose:
        """One pose that stands for all: the first, or the middle of the area; the origin for a whole map."""
        if self.poses:
            return self.poses[0]
        if self.area is None:
            return Pose()
        x1, y1, x2, y2 = self.area
        return Pose((x1 + x2) / 2, (y1 + y2) / 2, sum(self.headings) / 2)

    @property
    def description(self) -> str:
        """``(0, 0)``, ``one of 4 places``, ``anywhere``."""
        if self.model is not None:
            return f"the moving {self.model}"
        if len(self.poses) == 1:
            return f"({self.poses[0].x:g}, {self.poses[0].y:g})"
        if self.poses:
            return f"one of {len(self.poses)} places"
        if self.area is None:
            return "anywhere on free floor"
        x1, y1, x2, y2 = self.area
        return f"anywhere free from ({x1:g}, {y1:g}) to ({x2:g}, {y2:g})"


@dataclass(frozen=True, slots=True)
class CurriculumStage:
    """Some of the cases, until all of them go well enough. After the last stage all cases are practised."""

    on: tuple[str, ...]
    """Cases or groups of cases."""
    success: float
    """The next stage comes when each of these cases succeeds this often in a test."""


Curriculum = tuple[CurriculumStage, ...]


def read_curriculum(sections: Sequence[Section], cases: Sequence[tuple[str, str]]) -> Curriculum:
    """Reads the stages from a task's file; ``cases``: the name and group of each case. What is wrong is noted."""
    known = tuple(dict.fromkeys(name for case in cases for name in case if name))
    stages = []
    for section in sections:
        names = section.texts("on", at_least=1)
        for name in names:
            if cases and name not in known:
                section.error(f"there is no case or group {quoted(name)}: {suggestion(name, known)}", "on")
        stages.append(CurriculumStage(names, section.number("success", 0.9, above=0, maximum=1)))
        section.finish()
    return tuple(stages)


@dataclass(frozen=True, slots=True)
class CasePractice:
    """Which of a task's cases are practised in a stage."""

    cases: tuple[str, ...]
    success: float

    def is_over(self, shares: dict[str, float]) -> bool:
        """Whether each of its cases succeeds often enough; ``shares``: by case."""
        return all(shares[name] >= self.success for name in self.cases)

    def world_shares(self, names: Sequence[str]) -> FloatArray:
        """(cases,) which part of the worlds each of the task's cases gets."""
        practised: FloatArray = np.array([float(name in self.cases) for name in names])
        practised /= practised.sum()
        return practised


def practices(curriculum: Curriculum, cases: Sequence[tuple[str, str]]) -> tuple[CasePractice, ...]:
    """The stages on the cases that there are, each with its name and group; a stage that has none of them is left out."""
    found = []
    for stage in curriculum:
        names = tuple(name for name, group in cases if {name, group} & set(stage.on))
        if names:
            found.append(CasePractice(names, stage.success))
    return tuple(found)


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


@dataclass(frozen=True, slots=True)
class TaskCase:
    """One case of a task: where its episodes start and end. In metres and radians."""

    name: str
    starts: tuple[EpisodePlaces, ...]
    """One for each robot. Where several have lists of poses, all take the same place in their lists."""
    targets: EpisodePlaces
    start_shift: tuple[float, float] = (0.0, 0.0)
    """Largest random displacement of all robots' starts along x and y [m], to either side."""
    target_shift: tuple[float, float] = (0.0, 0.0)
    is_heading_random: bool = False
    """Whether the heading at the start is drawn at random."""
    group: str = ""
    """Cases that results are given for together; may be empty."""

    @classmethod
    def from_map(cls, case: MapCase) -> TaskCase:
        """The case of a map's card."""
        starts = [case.start] if case.partner_start is None else [case.start, case.partner_start]
        return cls(
            case.name,
            tuple(EpisodePlaces((start,)) for start in starts),
            EpisodePlaces((Pose(*case.target),)),
            case.start_shift,
            case.target_shift,
            case.is_heading_random,
            case.group,
        )

    @property
    def start(self) -> Pose:
        """The first robot's start, or a pose that stands for all of them."""
        return self.starts[0].nominal

    @property
    def target(self) -> tuple[float, float]:
        """The target's usual place, or one that stands for all of them."""
        return self.targets.nominal.x, self.targets.nominal.y


@dataclass(frozen=True, slots=True)
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
        """Where a patrol goes: the case's targets of all rounds, in their order [m, m]. Empty for any other goal."""
        if not isinstance(self.goal, PatrolGoal):
            return ()
        return self.goal.route(tuple((each.x, each.y) for each in case.targets.poses))

    def robots_on(self, card: MapCard) -> tuple[str, ...]:
        """The models that drive on a map."""
        return self.robot_names or tuple(name for name in (card.robot, card.partner) if name)

    def on(self, *names: str) -> LearningTask:
        """The same task on some of its cases, named one by one or by their groups.

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
