"""Runs and judges one drive of a level by keys, a controller or an agent: what the level asks for, measured as it is driven."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import partial
from pathlib import Path
from random import Random, SystemRandom
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from kit.controllers import ControllerFile, find_controller, kit_controllers
from kit.geometry import Pose
from kit.host.failure import Failure, FailureKind
from kit.host.private_folder import private_folder
from kit.host.sandbox.limits import INTERACTIVE_LIMITS, Limits
from kit.host.sandbox.probe import is_level_available
from kit.host.sandbox.sandbox_config import INTERACTIVE_LEVEL
from kit.host.sandbox.sandbox_config import Level as Confinement
from kit.run.episode import EndReason, run_until, when, when_failed
from kit.run.lockstep import Observer
from kit.run.metrics import MetricsRecorder
from kit.run.recording import Playback, Recorder, Recording
from kit.run.scenario import Scenario
from kit.run.session import Session
from kit.school.game.levels import GameLevel, LevelConditions
from kit.school.game.objective import Objective
from kit.school.game.starts import OWN_SEED, draw_seeds, scenario_from
from kit.sim.simulation import STEP_SIZE_S, Simulation

if TYPE_CHECKING:
    from kit.learning.policies.policy import Policy
    from kit.run.view import View


DOCK_RADIUS: Final = 0.25
"""A robot stands at a dock within this distance of it [m]."""
DOCK_TIME: Final = 1.0
"""Standing still for this time charges the battery [s]."""
STILL: Final = 1e-4
"""A robot that moves less than this in a tick stands still [m]."""


class Battery:
    """The charge of a robot's battery: used by driving, refilled by standing still at a dock."""

    def __init__(self, conditions: LevelConditions, robot: str) -> None:
        self._conditions, self._robot = conditions, robot
        self.charge = conditions.charge
        """Distance that is left [m]."""
        self._still_s = 0.0
        self._last: tuple[float, float] | None = None

    @property
    def is_empty(self) -> bool:
        return self._conditions.charge > 0.0 and self.charge <= 0.0

    def on_step(self, simulation: Simulation) -> None:
        x, y, _ = simulation.pose(self._robot)
        stride = 0.0 if self._last is None else math.dist((x, y), self._last)
        self._last = x, y
        self.charge -= stride
        self._still_s = self._still_s + simulation.step_size if stride < STILL else 0.0
        is_docked = any(math.dist((x, y), dock) <= DOCK_RADIUS for dock in self._conditions.docks)
        if is_docked and self._still_s >= DOCK_TIME:
            self.charge = self._conditions.charge


class Wedge:
    """How long driven robots have stood still while something touched one of them: no bump puts a program's robot back."""

    def __init__(self, robots: Sequence[str]) -> None:
        self._robots = robots
        self._poses: list[Pose] = []
        """Where they have stood since then."""
        self._seconds = 0.0

    @property
    def is_stuck(self) -> bool:
        return self._seconds >= STUCK_TIME

    def on_step(self, simulation: Simulation) -> None:
        poses = [simulation.pose(name) for name in self._robots]
        if any(map(_have_moved, self._poses, poses)) or not any(map(simulation.is_touching, self._robots)):
            self._seconds = 0.0
        if not self._seconds:
            self._poses = poses
        self._seconds += simulation.step_size


def _have_moved(before: Pose, after: Pose) -> bool:
    """Whether a robot has moved or turned by more than a push against a wall moves it."""
    turn = math.remainder(after.theta - before.theta, math.tau)
    return math.dist(before[:2], after[:2]) > STUCK_M or abs(turn) > STUCK_RAD


STUCK_TIME: Final = 5.0
"""A drive ends when no driven robot has moved for this time while one touches something [s]."""
STUCK_M, STUCK_RAD = 0.02, 0.05
"""A robot that has moved less [m] and turned less [rad] has not moved."""
NOT_MOVED: Final = "the robot never moved; a program moves it by a Twist that it publishes on cmd_vel"
STANDING_SPEED: Final = 0.02
"""A robot slower than this stands still [m/s]."""
OUTPUT_INTERVAL: Final = 10
"""Ticks after which the program's output is read."""
ALLOWED_SERVICES: Final = ("move_model", "pause", "resume", "toggle_pause", "change_rate")
"""World services allowed during a race; models may only be moved to their start."""


class DriverKind(StrEnum):
    """The kind of driver."""

    HAND = "hand"
    PROGRAM = "program"
    AGENT = "agent"

    @property
    def phrase(self) -> str:
        """How a drive by it was made, in words."""
        return f"by {self.value}"


@dataclass(frozen=True, slots=True)
class RaceFinish:
    """The end of one drive."""

    reached: bool
    """Whether all robots that are driven reached the target."""
    seconds: float
    """Simulated time until the target, or until the end [s]."""
    collisions: int
    """Collisions of all robots that are driven."""
    failure: Failure | None = None
    foul: str = ""
    """The rule that was broken, if any; the target then does not count as reached."""
    splits: tuple[float, ...] = ()
    """When each of several targets was reached [s]."""
    sensors: int | None = None
    """Topics of the robots that the program listened to; None for a drive by hand."""
    has_stopped: bool = False
    """Whether a robot stood still between its first move and the end."""
    is_stuck: bool = False
    """Whether the drive ended because no robot moved any more while one touched something."""
    is_apart: bool = False
    """Whether two robots were side by side for less of it than the level asks."""
    shortfall: str = ""
    """How much of the goal was achieved, and how far its next target was, where it was not reached; in words."""

    @property
    def is_flawed(self) -> bool:
        """Whether it earns bronze at best: something was touched, or a pair was apart for too long."""
        return self.collisions > 0 or self.is_apart

    def as_event(self, driver: DriverKind, recording: str | None) -> dict[str, Any]:
        """The content of the journal's event."""
        return {
            "driver": driver.value,
            "reached": self.reached,
            "seconds": round(self.seconds, 3),
            "bumps": self.collisions,
            "recording": recording,
        }


class RaceReferee(Observer):
    """Observes a runner: when all driven robots have reached the target, how often they collided, and any foul."""

    def __init__(self, level: GameLevel, scenario: Scenario, step_size: float = STEP_SIZE_S) -> None:
        """``scenario``: the level's own, as it was loaded; ``step_size``: of the runner's ticks [s]."""
        self._level = level
        self._scenario = scenario
        self._step_size = step_size
        self._last_tick = -1
        self._reset()

    def _reset(self) -> None:
        self._metrics = MetricsRecorder.for_scenario(self._scenario)
        self.objective = Objective(self._level, self._scenario, self._step_size)
        self.battery = Battery(self._level.conditions, self._scenario.partners[0])
        self._wedge = Wedge(self._scenario.partners)
        self._seconds = 0.0
        self._foul = ""
        self._has_moved = self._has_stopped = False
        self._positions: dict[str, tuple[float, float]] = {}

    @property
    def finish(self) -> RaceFinish:
        """The finish as of the last tick."""
        reached_s = self.objective.reached_s
        return RaceFinish(
            reached_s is not None and not self._foul,
            self._seconds if reached_s is None else reached_s,
            self._metrics.total_bumps,
            foul=self._foul,
            splits=self.objective.splits,
            has_stopped=self._has_stopped,
            is_stuck=reached_s is None and self._wedge.is_stuck,
            is_apart=self.objective.is_apart,
            shortfall=self._shortfall if reached_s is None else "",
        )

    def shown(self, view: View) -> View:
        """A view of the world with the level's targets and bumps in place of those of the map's case."""
        metrics = replace(
            view.metrics,
            bumps=self.finish.collisions,
            target_m=self.objective.target_m,
            reached_s=self.objective.reached_s,
        )
        return replace(view, metrics=metrics, scene=replace(view.scene, targets=self.objective.discs))

    @property
    def _shortfall(self) -> str:
        return self.objective.shortfall if self._has_moved else NOT_MOVED

    @property
    def is_over(self) -> bool:
        """Whether the goal is reached, a rule broken, the time over or the robot stuck."""
        is_reached = self.objective.reached_s is not None
        is_at_its_end = self._seconds >= self._level.time_limit or self._wedge.is_stuck
        return is_reached or bool(self._foul) or is_at_its_end

    def on_service(self, service: str, *arguments: Any) -> None:
        """Records a foul if a service that changes the world is called."""
        if service in ALLOWED_SERVICES[1:] or self.objective.reached_s is not None:
            return
        homes = dict(zip(self._scenario.partners, self._scenario.starts, strict=True))
        if service != ALLOWED_SERVICES[0] or tuple(arguments[1]) != tuple(homes.get(arguments[0], ())):
            self._foul = f"the world was changed during the race ({service})"
        else:
            self.objective.put_back()

    def on_step(self, simulation: Simulation) -> None:
        if simulation.tick <= self._last_tick:  # it was reset: a new drive
            self._reset()
        self._last_tick = simulation.tick
        if self.is_over:  # a world that is watched goes on until its screen has seen the end
            return
        self._seconds = simulation.time_ns / 1e9
        self._metrics.on_step(simulation)
        step = simulation.step_size
        strides = []
        for name in self._scenario.partners:
            pose = simulation.pose(name)
            before = self._positions.get(name, (pose.x, pose.y))
            stride = math.hypot(pose.x - before[0], pose.y - before[1])
            strides.append(stride)
            self._positions[name] = pose.x, pose.y
        is_moving = max(strides) > STANDING_SPEED * step
        self._has_stopped |= self._has_moved and not is_moving
        self._has_moved |= is_moving
        self.battery.on_step(simulation)
        self._wedge.on_step(simulation)
        self.objective.on_step(simulation)
        if self.battery.is_empty and self.objective.reached_s is None:
            self._foul = "the battery was empty"


def race_controller(
    level: GameLevel,
    controller: ControllerFile,
    *,
    on_second: Callable[[float], None] | None = None,
    wall_limit_s: float = math.inf,
    seed: int = OWN_SEED,
    confinement: Confinement | None = None,
    limits: Limits = INTERACTIVE_LIMITS,
) -> tuple[RaceFinish, Recording]:
    """Lets a controller drive the level once, as fast as the simulation runs. ``wall_limit_s``: seconds of wall clock after
    which it has failed. ``seed``: of the start. ``confinement``: by default that of a program which drives for medals."""

    def install_driver(session: Session) -> None:
        session.drive_with(controller)
        session.wait_until_driven()

    confinement = confinement_of(controller) if confinement is None else confinement
    scenario = scenario_from(level, seed)
    return run_race(level, scenario, install_driver, on_second, confinement, wall_limit_s, seed, limits)


def race_from_all_starts(
    level: GameLevel,
    controller: ControllerFile,
    *,
    first: tuple[RaceFinish, Recording] | None = None,
    on_second: Callable[[int, float], None] = lambda start, seconds: None,
    random: Random | None = None,
) -> list[tuple[RaceFinish, Recording]]:
    """Lets a controller drive the level from its own start and from drawn ones. ``first``: the drive from the level's own
    start, where it was watched. ``on_second``: gets the number of the start, from 1, and the seconds driven; what it raises
    ends the race. ``random``: draws the starts; by default nobody can tell which."""
    drives = [] if first is None else [first]
    seeds = draw_seeds(level, random or SystemRandom())
    for number, seed in enumerate(seeds[len(drives) :], len(drives) + 1):
        drives.append(race_controller(level, controller, on_second=partial(on_second, number), seed=seed))
    return drives


def finish_order(finish: RaceFinish) -> tuple[bool, bool, float]:
    """Smaller is better: at the goal, without a flaw, soon."""
    return not finish.reached, finish.is_flawed, finish.seconds


def middle_drive(finishes: Sequence[RaceFinish]) -> int:
    """The number of the drive that counts: as many are better as are worse."""
    in_order = sorted(range(len(finishes)), key=lambda number: finish_order(finishes[number]))
    return in_order[len(in_order) // 2]


def open_race(
    level: GameLevel, scenario: Scenario, controller: ControllerFile, way_out: str = ""
) -> tuple[Session, RaceReferee, Recorder]:
    """Opens the same race to be watched: the controller has started, and the first tick is still to come. ``way_out``: how to
    change there a program that sends no speed.

    The caller closes the session.
    """
    session = Session(scenario, seed=OWN_SEED, level=confinement_of(controller), always_scan=True)
    referee = RaceReferee(level, scenario)
    recorder = Recorder.for_scenario(scenario, session.runner.simulation)
    session.runner.observers += [referee, recorder]
    session.watch_connections(way_out)
    session.drive_with(controller)
    session.wait_until_driven()
    return session, referee, recorder


def confinement_of(controller: ControllerFile) -> Confinement:
    """Programs that are not the kit's are confined where the machine can: one that drives for medals must not touch the
    journal or the recordings."""
    is_stranger = controller not in kit_controllers()
    can_confine = is_stranger and is_level_available(Confinement.FILTERED)
    return Confinement.FILTERED if can_confine else INTERACTIVE_LEVEL


@contextmanager
def agent_controller(policy: Policy) -> Iterator[ControllerFile]:
    """The program of a trained policy, exported as the ROS 2 node it would be on a robot. Raises PolicyError."""
    from kit.learning.policies.policy_node import format_policy_node

    source = format_policy_node(policy)
    with private_folder() as folder:
        file = Path(folder, "agent.py")
        file.write_text(source)
        yield find_controller(str(file))


def run_again(level: GameLevel, recording: Recording) -> tuple[RaceFinish, Recording]:
    """Runs a recorded drive again, bit for bit, and judges it. Raises ValueError if it is of another level or from a start
    that it has not, and RecordingError where an input is not possible in its world."""
    scenario = scenario_from(level, recording.seed)
    if (recording.place, recording.case) != (scenario.name, level.case):
        raise ValueError(f"this is a drive of {recording.place} {recording.case or ''}, not of {level.title}")
    with Session(
        scenario, seed=recording.seed, step_size=recording.step_size, always_scan=level.goal.reads_lidar
    ) as session:
        referee = RaceReferee(level, scenario, recording.step_size)
        recorder = Recorder.for_scenario(scenario, session.runner.simulation)
        session.runner.observers += [referee, recorder]
        session.play_back(recording)
        run_until(session.runner, ticks=recording.ticks)
        return referee.finish, replace(recorder.recording(), inputs=recording.inputs)


def open_again(
    level: GameLevel, recording: Recording, controller: ControllerFile
) -> tuple[Session, RaceReferee, Recorder]:
    """Opens a drive from the level's own start where its recording ends: the world stands, so do the robots, and the controller
    is about to drive them. Raises as ``run_again``, and ValueError where the drive, run again, is another one.

    The caller closes the session.
    """
    scenario = scenario_from(level, recording.seed)
    if (recording.place, recording.case) != (scenario.name, level.case):
        raise ValueError(f"this is a drive of {recording.place} {recording.case or ''}, not of {level.title}")
    session = Session(scenario, seed=recording.seed, always_scan=True)
    try:
        runner = session.runner
        referee, recorder = RaceReferee(level, scenario), Recorder.for_scenario(scenario, runner.simulation)
        playback = Playback(recording, runner.accept, runner.call_service)
        runner.participants.append(playback)
        runner.observers += [playback, referee, recorder]
        run_until(runner, ticks=recording.ticks)
        if not np.array_equal(recorder.recording().poses, recording.poses):
            raise ValueError("run again, it is another drive")
        runner.paused = True
        session.stop_robot()
        session.drive_with(controller)
    except BaseException:  # Ctrl-C too: raised again
        session.close()
        raise
    return session, referee, recorder


def judge_recording(level: GameLevel, recording: Recording) -> RaceFinish:
    """The finish of a recorded drive. Raises as ``run_again``."""
    return run_again(level, recording)[0]


def run_race(
    level: GameLevel,
    scenario: Scenario,
    install_driver: Callable[[Session], None],
    on_second: Callable[[float], None] | None = None,
    confinement: Confinement = INTERACTIVE_LEVEL,
    wall_limit_s: float = math.inf,
    seed: int = OWN_SEED,
    limits: Limits = INTERACTIVE_LIMITS,
) -> tuple[RaceFinish, Recording]:
    """Runs a drive from ``scenario``'s start to its end. ``seed``: of that start."""
    ends_at = time.monotonic() + wall_limit_s
    with Session(
        scenario, seed=seed, level=confinement, limits=limits, always_scan=level.goal.reads_lidar
    ) as session:
        simulation = session.runner.simulation
        referee, recorder = RaceReferee(level, scenario), Recorder.for_scenario(scenario, simulation)
        session.runner.observers += [referee, recorder]
        install_driver(session)
        step = simulation.step_size

        def listen(tick: int) -> None:
            if tick % OUTPUT_INTERVAL == 0:
                session.read_output()
                if on_second is not None:
                    on_second(tick * step)

        reason = run_until(
            session.runner,
            ticks=math.ceil(level.time_limit / step),
            ends=(
                when_failed(session),
                when(lambda: referee.is_over),
                when(lambda: time.monotonic() > ends_at),
            ),
            before_tick=listen,
        )
        failure = session.failure
        if failure is None and reason is EndReason.STOPPED and not referee.is_over:
            failure = Failure(
                FailureKind.TIMEOUT,
                f"the race took longer than {wall_limit_s:g} s. Is the program very slow?",
            )
        finish = replace(referee.finish, failure=failure, sensors=sensors_in_use(session))
        return finish, recorder.recording()


def sensors_in_use(session: Session) -> int:
    """The number of topics that the driven robots publish and somebody listens to."""
    ends = (
        end for name in session.scenario.partners for end in session.runner.simulation.model_endpoints(name)
    )
    return sum(end.direction == "publish" and session.graph.subscription_count(end.topic) > 0 for end in ends)
