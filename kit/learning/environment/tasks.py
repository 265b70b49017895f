"""The tasks to learn, as records: the turn, the hallways, two wheelchairs; as in the dissertation, and our own.

Where the seed's text and its code differ, the text counts.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal

from kit.learning.environment.actions import FOUR_MOVES, SEVEN_MOVES, THREE_MOVES, Actions
from kit.learning.environment.disturbances import UNDISTURBED, Disturbances
from kit.learning.environment.observations import (
    NINE_NUMBERS,
    NINETEEN_NUMBERS,
    SEVENTEEN_NUMBERS,
    ObservationSpec,
)
from kit.learning.environment.rewards import (
    ALGORITHM_1,
    ALGORITHM_2,
    ALGORITHM_2_STOPPING,
    ALGORITHM_3,
    REWARD_SCALE,
    SIDE_BY_SIDE,
    Reward,
)
from kit.plain_text import quoted, suggestion
from kit.world.catalogue import MapCard, MapCase, find_map


class UnknownTask(LookupError):
    """No task, or no case of a task, has that name; the message offers the nearest one."""


@dataclass(frozen=True, slots=True)
class StartVariation:
    """Random variation of an episode's start and target around the map card's. Every draw is uniform."""

    shifted: bool = True
    """Whether start and target are shifted, and headings any, as the case allows."""
    noise: float = 0.0
    """m: up to this much along x and y, for every robot by itself."""
    max_rotation: float = 0.0
    """rad: up to this much to either side, likewise."""
    gap: float | None = None
    """m between two robots; None: as on the card."""


@dataclass(frozen=True, slots=True)
class LearningTask:
    """A task to learn: maps, observations, actions, reward and end conditions."""

    name: str
    summary: str
    maps: tuple[str, ...]
    """Maps of the catalogue; all with the same robots and laser beams."""
    robots: int
    actions: Actions
    observation: ObservationSpec
    reward: Reward
    cases: tuple[str, ...] = ()
    """Names of cases of these maps; all of them where empty."""
    step_time: float = 0.2
    """s"""
    collision_checks: int = 2
    """Into how many equal moves a step is divided; after each one, collisions are looked for."""
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
    """What differs from the robots' files, drawn anew for every episode."""
    path_end: float = 0.0
    """m: ``Transition.to_go`` does not fall below this."""
    timeout_terminal: bool = False
    """Whether running out of time ends an episode as if that were the world's doing. It is wrong (the agent cannot
    see the clock), and what the seed does; kept so that its harm can be shown."""

    def map_cases(self) -> tuple[tuple[MapCard, MapCase], ...]:
        """Every case with its map, in order. UnknownTask if one of ``cases`` is none of them."""
        found = tuple(_map_cases(self.maps))
        if not self.cases:
            return found
        by_name = {case.name: (card, case) for card, case in found}
        for name in self.cases:
            if name not in by_name:
                raise UnknownTask(f"task {self.name} has no case {quoted(name)}: {suggestion(name, by_name)}")
        return tuple(by_name[name] for name in self.cases)

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


def _map_cases(maps: tuple[str, ...]) -> Iterator[tuple[MapCard, MapCase]]:
    for name in maps:
        card = find_map(name)
        for case in card.cases:
            yield card, case


HALL_MAPS = (
    "hall_straight",
    "hall_left_door",
    "hall_center_door",
    "hall_right_door",
    "hall_two_doors",
    "hall_small_obstacle",
    "hall_large_obstacle",
    "hall_turn_90",
    "hall_curve_90",
    "hall_turn_180",
    "hall_curve_180",
)
PAIR_MAPS = ("pair_straight", "pair_turn_90", "pair_curve_90", "pair_turn_180", "pair_curve_180")

TURN = LearningTask(
    "turn",
    "Round one corner and back again",
    ("turn",),
    robots=1,
    actions=THREE_MOVES,
    observation=NINE_NUMBERS,
    reward=replace(ALGORITHM_3, scale=REWARD_SCALE),
    step_time=0.1,
    collision_checks=1,
    target_radius=0.2,
    start=StartVariation(noise=0.05, max_rotation=0.2),
)
TURN_SEED = replace(
    TURN,
    name="turn-seed",
    reward=ALGORITHM_3,
    observation=replace(NINE_NUMBERS, clip=10.0, scale=1.0),
    start=StartVariation(),
    timeout_terminal=True,
)
HALLWAY = LearningTask(
    "hallway",
    "Fifteen hallways with doors, obstacles and turns; one agent for all",
    HALL_MAPS,
    robots=1,
    actions=SEVEN_MOVES,
    observation=SEVENTEEN_NUMBERS,
    reward=replace(ALGORITHM_1, scale=REWARD_SCALE),
)
HALLWAY_SEED = replace(HALLWAY, name="hallway-seed", reward=ALGORITHM_1, timeout_terminal=True)
WHEELCHAIRS = LearningTask(
    "wheelchairs",
    "Two wheelchairs side by side, driven by one agent",
    PAIR_MAPS,
    robots=2,
    actions=replace(FOUR_MOVES, one_number=False),
    observation=replace(NINETEEN_NUMBERS, scale=6.0),  # a centimetre decides whether two are side by side
    reward=SIDE_BY_SIDE,
    max_steps=300,
    start=StartVariation(gap=0.4, noise=0.05, max_rotation=0.1),
    target_radius=0.4,
    path_end=0.3,
)
WHEELCHAIRS_SEED = replace(
    WHEELCHAIRS,
    name="wheelchairs-seed",
    reward=ALGORITHM_2_STOPPING,
    actions=FOUR_MOVES,
    observation=NINETEEN_NUMBERS,
    start=StartVariation(gap=0.4),
    path_end=0.0,
    timeout_terminal=True,
)
WHEELCHAIRS_SEED_49 = replace(
    WHEELCHAIRS_SEED,
    name="wheelchairs-seed-49",
    reward=ALGORITHM_2,
    actions=SEVEN_MOVES,
    start=StartVariation(),
    target_radius=0.25,
)

TASKS = (TURN, TURN_SEED, HALLWAY, HALLWAY_SEED, WHEELCHAIRS, WHEELCHAIRS_SEED, WHEELCHAIRS_SEED_49)


def find_task(name: str) -> LearningTask:
    """The task of that name. UnknownTask if there is none."""
    by_name = {task.name: task for task in TASKS}
    if name not in by_name:
        raise UnknownTask(f"there is no task {quoted(name)}: {suggestion(name, by_name)}")
    return by_name[name]
