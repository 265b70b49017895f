"""Two players in one world: the scenario with a second robot, and the rules of a race and of tag.

The host's process runs the world. What players send are the pushes of their keys, nothing else: no code, no messages.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import TYPE_CHECKING, Final

from kit.fields.occupancy_grid import occupancy_grid_of
from kit.geometry import Pose
from kit.msg.geometry_msgs import Twist
from kit.run.lockstep import Observer
from kit.run.metrics import is_in_target
from kit.run.scenario import Scenario
from kit.school.game.levels import SPEED, TURN_RATE, GameLevel
from kit.school.game.starts import scenario_from
from kit.sim.simulation import Simulation

if TYPE_CHECKING:
    from kit.run.recording import Recording
    from kit.run.runner import Runner

GUEST: Final = "guest"
"""Name of the second robot's model."""
PLAYERS: Final = 2
ROOM: Final = 0.15
"""Free way around the second robot's start [m]."""
COUNTDOWN: Final = 3.0
"""Between the second player's coming and the start [s]."""
TAG_DISTANCE: Final = 0.3
"""Between the middles of two robots of which one catches the other [m]: they all but touch."""
TAG_PAUSE: Final = 2.0
"""After a catch nobody is caught for this time [s]."""
TAG_SECONDS: Final = 90.0
"""A game of tag lasts this long [s]."""
STILL_SECONDS: Final = 3.0
STILL_DISTANCE: Final = 0.3
"""A robot stands still once it has stayed for longer than this [s] within this distance of one place [m]."""
CATCH_DISTANCE: Final = 0.1
"""Who becomes the catcher catches nobody before it has moved so far [m]: else whoever stands beside it would be caught."""
TAG_RULE: Final = (
    "The catcher gets 1 s of penalty each second. If only the other robot has stayed on one spot for "
    f"{STILL_SECONDS:.0f} s, that one gets it instead. After {TAG_SECONDS:.0f} s the lower penalty wins."
)


class SharedMode(StrEnum):
    """The games that two players can play."""

    RACE = "race"
    TAG = "tag"


class SharedPhase(StrEnum):
    """How far a shared game is."""

    WAITING = "waiting"
    """For the second player."""
    COUNTDOWN = "countdown"
    RUNNING = "running"
    OVER = "over"


class CannotShare(Exception):
    """This level is not for two; the message says why."""


@dataclass(frozen=True, slots=True)
class SharedGameState:
    """One instant of a shared game: all that players and spectators are told."""

    phase: SharedPhase
    seconds: float
    """Time in this phase [simulated s]."""
    poses: tuple[Pose, ...]
    """Poses of the host's and the guest's robot."""
    scores: tuple[float, ...]
    """In a race the number of targets reached, in tag the seconds that count against each."""
    catcher: int | None = None
    """The catcher in tag."""
    winner: int | None = None
    """Once it is over; None if nobody has won."""
    names: tuple[str, ...] = ("",) * PLAYERS
    """Of the players; empty for one who has not come yet."""
    asks_again: bool = False
    """Whether the second player asks for another game, after one that is over."""
    watching: tuple[str, ...] = ()
    """Names of those who only watch."""
    has_left: bool = False
    """Whether it is over, or waits again, because the player who has not won has left."""
    wins: tuple[int, ...] = (0,) * PLAYERS
    """Games that each has won against the other so far."""
    catches: tuple[float, ...] = ()
    """When somebody was caught in tag [simulated s of the game], and so caught from then on."""

    def next_targets(
        self, targets: Sequence[tuple[float, float]], player: int | None
    ) -> list[tuple[float, float]]:
        """The next targets in a race, for one player, or for all."""
        reached = {round(score) for score in (self.scores if player is None else [self.scores[player]])}
        return [targets[each] for each in sorted(reached) if each < len(targets)]


def recorded_scenario(level: GameLevel, recording: Recording) -> Scenario:
    """The scenario in which a drive of a level was recorded, for one player or for two. Raises as ``shared_scenario``."""
    is_shared = any(GUEST in names for _, names in recording.models)
    return shared_scenario(level) if is_shared else scenario_from(level, recording.seed)


def shared_scenario(level: GameLevel) -> Scenario:
    """A level's scenario with a second robot beside the first. Raises CannotShare, LookupError, WorldError."""
    scenario = level.find_scenario()
    if len(scenario.partners) != 1 or not level.goal.has_standing_targets or scenario.case is None:
        raise CannotShare(f"{level.title} is not a race to a target for one robot: choose another level.")
    first = scenario.driven
    assert first is not None  # it has a partner
    world = scenario.world
    grid = occupancy_grid_of(world)
    for turn in (math.pi / 2, -math.pi / 2, math.pi):
        angle = first.pose.theta + turn
        for distance in (0.4, 0.5, 0.35):
            x, y = first.pose.x + distance * math.cos(angle), first.pose.y + distance * math.sin(angle)
            cell = grid.cell_at(x, y)
            if grid.inside[cell] and grid.clearance[cell] >= ROOM:
                second = replace(first, name=GUEST, namespace=GUEST, pose=Pose(x, y, first.pose.theta))
                return replace(scenario, world=replace(world, models=(*world.models, second)))
    raise CannotShare(f"{level.title} has no room for a second robot at its start: choose another level.")


class SharedReferee(Observer):
    """Judges a game of two robots in one world. Belongs to the thread that ticks.

    Tag is scored as a game of pursuit and evasion is, by the time to capture (R. Isaacs: Differential Games, 1965): each second
    counts against the catcher. While the one that is chased stands still and the catcher does not, it counts against that one
    instead: each second counts against one of the two, and neither gains by standing still.
    """

    def __init__(self, scenario: Scenario, mode: SharedMode, simulation: Simulation) -> None:
        """``scenario``: of ``shared_scenario``."""
        assert scenario.robot is not None
        assert scenario.case is not None
        self.mode: Final = mode
        self.robots: Final = (scenario.robot, GUEST)
        self._simulation = simulation
        self._scores = [0.0] * PLAYERS
        self._targets = scenario.targets or (scenario.case.target,)
        self._radius = scenario.case.target_radius
        self._phase = SharedPhase.WAITING
        self._since_ns = self._now_ns = 0
        self._catcher: int | None = 0 if mode is SharedMode.TAG else None
        self._caught_ns = 0
        self._catches: list[float] = []
        self._places: list[tuple[float, float]] = []
        """Where each robot was when it had last moved on; empty where that is not known yet."""
        self._catcher_place = (0.0, 0.0)
        self._has_moved = False
        """Whether the catcher has moved since it became that."""
        self._moved_ns = [0] * PLAYERS
        self._winner: int | None = None

    @property
    def is_over(self) -> bool:
        return self._phase is SharedPhase.OVER

    @property
    def state(self) -> SharedGameState:
        """State after the last tick."""
        return SharedGameState(
            self._phase,
            (self._now_ns - self._since_ns) / 1e9,
            tuple(map(self._simulation.pose, self.robots)),
            tuple(self._scores),
            self._catcher,
            self._winner,
            catches=tuple(self._catches),
        )

    def begin(self) -> None:
        """The game runs from the next tick on."""
        self._catches = []
        self._enter(SharedPhase.RUNNING)

    def on_step(self, simulation: Simulation) -> None:
        if simulation.time_ns < self._now_ns:  # the world was reset: the phase begins again
            self._since_ns = self._caught_ns = 0
            self._places = []
            self._catches = []
        self._now_ns = simulation.time_ns
        seconds = (self._now_ns - self._since_ns) / 1e9
        if self._phase is SharedPhase.COUNTDOWN and seconds >= COUNTDOWN:
            self.begin()
        elif self._phase is SharedPhase.RUNNING:
            if self.mode is SharedMode.RACE:
                self._judge_race(simulation)
            else:
                self._judge_tag(simulation, seconds)

    def _enter(self, phase: SharedPhase) -> None:
        self._phase, self._since_ns, self._places = phase, self._now_ns, []

    def _judge_race(self, simulation: Simulation) -> None:
        for number, robot in enumerate(self.robots):
            target = self._targets[round(self._scores[number])]
            if is_in_target(simulation, robot, target, self._radius):
                self._scores[number] += 1
            if self._scores[number] == len(self._targets):
                self._winner = number
                self._enter(SharedPhase.OVER)
                return

    def _judge_tag(self, simulation: Simulation, seconds: float) -> None:
        assert self._catcher is not None
        step = simulation.step_size
        poses = [simulation.pose(robot) for robot in self.robots]
        chased = 1 - self._catcher
        is_chased_alone_still = self._stands_still(poses) == [number == chased for number in range(PLAYERS)]
        self._scores[chased if is_chased_alone_still else self._catcher] += step
        moved_m = math.dist(self._catcher_place, poses[self._catcher][:2])
        self._has_moved = self._has_moved or moved_m >= CATCH_DISTANCE
        is_near = math.dist(poses[0][:2], poses[1][:2]) <= TAG_DISTANCE
        if (
            is_near
            and self._has_moved
            and self._now_ns - max(self._caught_ns, self._since_ns) >= TAG_PAUSE * 1e9
        ):
            self._catcher, self._caught_ns, self._places = chased, self._now_ns, []
            self._catches.append(seconds)
        if seconds >= TAG_SECONDS:
            first, second = self._scores
            self._winner = None if math.isclose(first, second, abs_tol=step) else int(second < first)
            self._enter(SharedPhase.OVER)

    def _stands_still(self, poses: Sequence[Pose]) -> list[bool]:
        """Whether each robot has stayed on one spot for too long."""
        if not self._places:
            self._places, self._moved_ns = [(each.x, each.y) for each in poses], [self._now_ns] * PLAYERS
            self._has_moved, self._catcher_place = False, self._places[self._catcher or 0]
        for number, pose in enumerate(poses):
            if math.dist(self._places[number], pose[:2]) >= STILL_DISTANCE:
                self._places[number], self._moved_ns[number] = (pose.x, pose.y), self._now_ns
        return [self._now_ns - moved > STILL_SECONDS * 1e9 for moved in self._moved_ns]


@dataclass(slots=True)
class _Player:
    topics: tuple[str, ...]
    push: tuple[float, float] = (0.0, 0.0)
    """Forward and left, each from -1 to 1."""
    sent: tuple[float, float] | None = None


class SharedGame(SharedReferee):
    """Moves both robots as their players push, and judges. Belongs to the thread that ticks, but for ``push``."""

    def __init__(self, scenario: Scenario, mode: SharedMode, runner: Runner) -> None:
        """``scenario``: of ``shared_scenario``."""
        super().__init__(scenario, mode, runner.simulation)
        self._runner = runner
        self._players = tuple(_Player(runner.simulation.command_topics(robot)) for robot in self.robots)
        self._has_second = False
        self._asks_again = self._has_left = False
        self._first_catcher = self._catcher
        self._wins = [0] * PLAYERS

    @property
    def state(self) -> SharedGameState:
        asks_again = self._asks_again and self.is_over
        return replace(super().state, asks_again=asks_again, has_left=self._has_left, wins=tuple(self._wins))

    def _enter(self, phase: SharedPhase) -> None:
        super()._enter(phase)
        if self.is_over and self._winner is not None:
            self._wins[self._winner] += 1

    def push(self, player: int, linear: float, angular: float) -> None:
        """What a player's keys ask for now, forward and left, each from -1 to 1; more is cut. From any thread."""
        self._players[player].push = min(max(linear, -1.0), 1.0), min(max(angular, -1.0), 1.0)

    def start(self) -> None:
        """The second player has come: the countdown begins."""
        if not self._has_second:  # another one
            self._wins = [0] * PLAYERS
        self._has_second = True
        if self._phase is SharedPhase.WAITING:
            self._has_left = False
            self._enter(SharedPhase.COUNTDOWN)

    def ask_again(self) -> None:
        """The second player asks for another game, after one that is over. From any thread."""
        self._asks_again = self.is_over

    def remove_player(self, player: int) -> None:
        """A player has gone: the other has won, if it had begun."""
        self.push(player, 0.0, 0.0)
        self._asks_again = False
        self._has_second = False
        if self._phase is SharedPhase.RUNNING:
            self._winner, self._has_left = 1 - player, True
            self._enter(SharedPhase.OVER)
        elif self._phase is SharedPhase.COUNTDOWN:
            self._has_left = True
            self._enter(SharedPhase.WAITING)

    def rematch(self) -> None:
        """Begins another game after one that is over, with its countdown or by waiting for a second player; in tag the other one
        catches first. In the world's thread."""
        if self._phase is not SharedPhase.OVER:
            return
        self._scores = [0.0] * PLAYERS
        self._winner = None
        self._asks_again = self._has_left = False
        if self._first_catcher is not None:
            self._first_catcher = 1 - self._first_catcher
        self._catcher = self._first_catcher
        self._enter(SharedPhase.COUNTDOWN if self._has_second else SharedPhase.WAITING)

    def on_step(self, simulation: Simulation) -> None:
        super().on_step(simulation)
        self._move()

    def _move(self) -> None:
        """Hands on what has changed; robots stand still unless the game runs."""
        for player in self._players:
            push = player.push if self._phase is SharedPhase.RUNNING else (0.0, 0.0)
            if push != player.sent:
                player.sent = push
                command = Twist()
                command.linear.x, command.angular.z = SPEED * push[0], TURN_RATE * push[1]
                for topic in player.topics:
                    self._runner.accept(topic, command)
