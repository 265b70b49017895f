"""One episode: what a controller is told of its scenario, when the episode ends, and the loop that runs it.

Playing, racing, a lesson's scene, a study and a grade are the same episode watched by different observers.
Metrics are those of ``kit.run.metrics``; a world that a face paces in a thread is run by ``kit.run.world_thread``.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:  # a launch without a world must not load the physics
    from kit.geometry import Pose
    from kit.host.failure import Failure
    from kit.run.metrics import MetricsRecorder
    from kit.run.pacing import Schedule
    from kit.run.scenario import Scenario


def controller_arguments(scenario: Scenario, home: Pose | None = None) -> list[str]:
    """Command line arguments for every program that drives in ``scenario``, as ROS 2 has them.

    Parameters: ``home`` [x m, y m, theta rad], ``model`` (the robot's name), ``models`` (all that drive), ``world``
    (its file), ``charges`` (a file, if given), and where the scenario has a target ``target`` [x m, y m] and
    ``target_radius`` [m]. Where it has several, ``target`` is the first, and ``targets`` [x1 m, y1 m, x2 m, y2 m, ...]
    are all in their order, one that is to be reached in every round once for each round.
    ``target_heading`` [rad] is given where the target has one that is asked for, and ``leader_frame`` where it moves: its
    frame on /tf. Relative topics are in the robot's namespace. Empty in a world without a robot.

    ``home``: where the robot starts, by default where the world has it.
    """
    robot = scenario.driven
    if robot is None:
        return []
    start = robot.pose if home is None else home
    parameters = {
        "home": f"[{start.x!r}, {start.y!r}, {start.theta!r}]",
        "model": json.dumps(robot.name),
        "models": json.dumps(scenario.partners),
        "world": json.dumps(str(scenario.world.file.absolute())),
    }
    if scenario.charges is not None:
        parameters["charges"] = json.dumps(str(scenario.charges.absolute()))
    if scenario.case is not None:
        x, y = scenario.case.target
        parameters["target"] = f"[{x!r}, {y!r}]"
        parameters["target_radius"] = repr(float(scenario.case.target_radius))
    if len(scenario.targets) > 1:
        parameters["targets"] = json.dumps([float(each) for point in scenario.targets for each in point])
    if scenario.target_heading is not None:
        parameters["target_heading"] = repr(float(scenario.target_heading))
    if scenario.leader is not None and (frame := scenario.leader_frame):
        parameters["leader_frame"] = json.dumps(frame)
    words = [word for name, value in parameters.items() for word in ("-p", f"{name}:={value}")]
    namespace = ["-r", f"__ns:=/{robot.namespace}"] if robot.namespace else []
    return ["--ros-args", *words, *namespace]


class EndReason(StrEnum):
    """Why an episode ended."""

    LIMIT = "limit"
    """Its time was over."""
    REACHED = "reached"
    """Every robot that is to arrive has arrived."""
    FAILED = "failed"
    """The program that drives failed."""
    STOPPED = "stopped"
    """Something else that the caller waited for."""


@dataclass(frozen=True, slots=True)
class EndCondition:
    """Ends an episode as soon as ``is_met()``; asked before each tick and after the last."""

    reason: EndReason
    is_met: Callable[[], bool]


class _CanFail(Protocol):
    @property
    def failure(self) -> Failure | None: ...


def when_failed(program: _CanFail) -> EndCondition:
    """Ends the episode when the program, or the session that runs it, has failed."""
    return EndCondition(EndReason.FAILED, lambda: program.failure is not None)


def when_reached(metrics: MetricsRecorder) -> EndCondition:
    """Ends the episode when all robots that are measured are in the target together."""
    return EndCondition(EndReason.REACHED, lambda: metrics.all_reached_s is not None)


def when(is_met: Callable[[], bool]) -> EndCondition:
    """Ends the episode for a reason of the caller's."""
    return EndCondition(EndReason.STOPPED, is_met)


class Tickable(Protocol):
    """A runner, or a graph without a world that is ticked like one."""

    @property
    def step_size(self) -> float:
        """Simulated seconds per tick."""

    def tick(self) -> None: ...


def run_until(
    run: Tickable,
    *,
    limit_s: float | None = None,
    ticks: int | None = None,
    ends: Sequence[EndCondition] = (),
    schedule: Schedule | None = None,
    before_tick: Callable[[int], object] | None = None,
) -> EndReason:
    """Ticks ``run`` until one of ``ends`` is met or the limit is reached, and returns why it ended.

    ``limit_s``: simulated seconds, rounded to whole ticks; ``ticks``: the same limit as a number of ticks; without
    either only ``ends`` end the episode. ``schedule``: waits until each tick is due; without one the episode runs as
    fast as it can. ``before_tick``: called before each tick with its number, 0 for the first.
    """
    if ticks is None and limit_s is not None:
        ticks = round(limit_s / run.step_size)
    number = 0
    while True:
        for end in ends:
            if end.is_met():
                return end.reason
        if ticks is not None and number >= ticks:
            return EndReason.LIMIT
        if schedule is not None:
            schedule.wait()
        if before_tick is not None:
            before_tick(number)
        run.tick()
        number += 1
