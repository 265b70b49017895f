"""Runs and judges one drive of a level, by the keys, a controller or a trained agent."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from kit.controllers import ControllerFile, find_controller, kit_controllers
from kit.host.failure import Failure
from kit.host.private_folder import private_folder
from kit.host.sandbox.confinement import INTERACTIVE_LEVEL
from kit.host.sandbox.confinement import Level as Confinement
from kit.host.sandbox.probe import is_level_available
from kit.run.episode import EndCondition, EndReason, run_until, when_failed
from kit.run.lockstep import Observer
from kit.run.metrics import MetricsRecorder
from kit.run.recording import Recorder, Recording
from kit.run.scenario import Scenario
from kit.run.session import Session
from kit.school.game.levels import GameLevel
from kit.school.game.reference_driver import ReferenceDriver
from kit.sim.simulation import Simulation

if TYPE_CHECKING:
    from kit.learning.policies.policies import Policy

TIME_LIMIT_PARS: Final = 6.0
"""A drive ends after this many times the level's par time."""
OUTPUT_INTERVAL: Final = 10
"""Ticks after which the program's output is read."""
MAX_SPEED: Final = 1.05
"""Allowed speed [m/s]: the simulation would accept more, a real robot of this kind would not reach it."""
RESET_DISTANCE: Final = 0.5
"""Distance [m]: a longer way in one step is not driving, but the reset to the start after a collision."""
ALLOWED_SERVICES: Final = ("move_model", "pause", "resume", "toggle_pause", "change_rate")
"""World services allowed during a race; models may only be moved to their start."""
SEED: Final = 1
"""Seed of every race, so that conditions are equal."""
PAIR_DRIVER: Final = "abreast"
"""The kit's controller that drives two robots side by side."""


class DriverKind(StrEnum):
    """The kind of driver."""

    KEYS = "keys"
    CONTROLLER = "controller"
    AGENT = "agent"


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

    def earned_stars(self, par: float) -> tuple[bool, bool, bool]:
        """Stars: finished, finished without a collision, finished under par."""
        return self.reached, self.reached and self.collisions == 0, self.reached and self.seconds <= par

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

    def __init__(self, scenario: Scenario) -> None:
        self._scenario = scenario
        self._last_tick = -1
        self._reset()

    def _reset(self) -> None:
        self._metrics = MetricsRecorder.for_scenario(self._scenario)
        self._seconds = 0.0
        self._foul = ""
        self._positions: dict[str, tuple[float, float]] = {}

    @property
    def finish(self) -> RaceFinish:
        """The finish as of the last tick."""
        reached_s = self._metrics.all_reached_s
        seconds = self._seconds if reached_s is None else reached_s
        has_reached = reached_s is not None and not self._foul
        return RaceFinish(has_reached, seconds, self._metrics.total_bumps, foul=self._foul)

    @property
    def when_finished(self) -> EndCondition:
        """Ends the race when all have reached the target without a foul."""
        return EndCondition(EndReason.REACHED, lambda: self.finish.reached)

    def on_service(self, service: str, *arguments: Any) -> None:
        """Records a foul if a service that changes the world is called."""
        if service in ALLOWED_SERVICES[1:] or self._metrics.all_reached_s is not None:
            return
        homes = dict(zip(self._scenario.partners, self._scenario.starts, strict=True))
        if service != ALLOWED_SERVICES[0] or tuple(arguments[1]) != tuple(homes.get(arguments[0], ())):
            self._foul = f"the world was changed during the race ({service})"

    def on_step(self, simulation: Simulation) -> None:
        if simulation.tick <= self._last_tick:  # it was reset: a new drive
            self._reset()
        self._last_tick = simulation.tick
        self._seconds = simulation.time_ns / 1e9
        if self._metrics.all_reached_s is not None:
            return
        self._metrics.on_step(simulation)
        for name in self._scenario.partners:
            pose = simulation.pose(name)
            before = self._positions.get(name, (pose.x, pose.y))
            stride = math.hypot(pose.x - before[0], pose.y - before[1])
            self._positions[name] = pose.x, pose.y
            if MAX_SPEED * simulation.step_size < stride < RESET_DISTANCE:
                self._foul = f"it drove faster than {MAX_SPEED:g} m/s, which this robot cannot"


def drive_reference(level: GameLevel) -> tuple[RaceFinish, Recording]:
    """Drives the level as reference: with the reference driver for one robot, with the kit's pair controller for two."""
    scenario = level.find_scenario()
    if len(scenario.partners) > 1:
        return race_controller(level, find_controller(PAIR_DRIVER))
    return _run_race(
        level, scenario, lambda session: session.runner.participants.append(ReferenceDriver(session))
    )


def race_controller(
    level: GameLevel, controller: ControllerFile, *, on_second: Callable[[float], None] | None = None
) -> tuple[RaceFinish, Recording]:
    """Lets a controller drive the level, as fast as the simulation runs."""

    def install_driver(session: Session) -> None:
        session.drive_with(controller)
        session.wait_until_driven()

    # Confined where the machine can: a program that drives for stars must not touch the journal or the recordings.
    is_stranger = controller not in kit_controllers()
    confinement = (
        Confinement.FILTERED
        if is_stranger and is_level_available(Confinement.FILTERED)
        else INTERACTIVE_LEVEL
    )
    return _run_race(level, level.find_scenario(), install_driver, on_second, confinement)


def race_agent(
    level: GameLevel, policy: Policy, *, on_second: Callable[[float], None] | None = None
) -> tuple[RaceFinish, Recording]:
    """Lets a trained policy drive the level, exported as the ROS 2 node it would be on a robot. Raises PolicyError."""
    from kit.learning.policies.policy_node import format_policy_node

    source = format_policy_node(policy)
    with private_folder() as folder:
        file = Path(folder, "agent.py")
        file.write_text(source)
        return race_controller(level, find_controller(str(file)), on_second=on_second)


def judge_recording(level: GameLevel, recording: Recording) -> RaceFinish:
    """Runs a recorded drive again, bit for bit, and judges it. Raises ValueError if it is of another level."""
    scenario = level.find_scenario()
    if (recording.place, recording.case) != (scenario.name, level.case):
        raise ValueError(f"this is a drive of {recording.place} {recording.case or ''}, not of {level.title}")
    with Session(scenario, seed=recording.seed, step_size=recording.step_size) as session:
        referee = RaceReferee(scenario)
        session.runner.observers.append(referee)
        session.play_back(recording)
        run_until(session.runner, ticks=recording.ticks, ends=(referee.when_finished,))
        return referee.finish


def _run_race(
    level: GameLevel,
    scenario: Scenario,
    install_driver: Callable[[Session], None],
    on_second: Callable[[float], None] | None = None,
    confinement: Confinement = INTERACTIVE_LEVEL,
) -> tuple[RaceFinish, Recording]:
    with Session(scenario, seed=SEED, level=confinement) as session:
        simulation = session.runner.simulation
        referee, recorder = RaceReferee(scenario), Recorder(scenario.name, level.case, simulation)
        session.runner.observers += [referee, recorder]
        install_driver(session)
        step = simulation.step_size

        def listen(tick: int) -> None:
            if tick % OUTPUT_INTERVAL == 0:
                session.read_output()
                if on_second is not None:
                    on_second(tick * step)

        run_until(
            session.runner,
            ticks=math.ceil(TIME_LIMIT_PARS * level.par / step),
            ends=(when_failed(session), referee.when_finished),
            before_tick=listen,
        )
        finish = referee.finish
        return replace(finish, failure=session.failure), recorder.recording()
