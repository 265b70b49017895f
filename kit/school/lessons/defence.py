"""The defence of a program: three questions on what the student's own program will do from a start it has not seen.

The program is run, so the answers are facts. The questions get harder: whether it moves in the end, which way it turns
first, whether and when it touches something.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from kit.run.episode import run_until, when_failed
from kit.world.problems import WorldError

if TYPE_CHECKING:
    from kit.run.recording import Recording
    from kit.run.scenario import Scenario

SECONDS: Final = 10.0
"""Simulated time of the run that is asked about [s]."""
STARTS: Final = 40
"""Starts that are tried until one is free."""
TURN: Final = math.radians(30)
"""The change of heading from which on it counts as a turn [rad]."""
STILL_M: Final = 0.01
"""The way in the last half second up to which a robot stands still [m]; as for its heading in rad."""


class DefenceError(Exception):
    """The program cannot be asked about; the message says why."""


@dataclass(frozen=True, slots=True)
class DefenceQuestion:
    """One question; the run has decided which option is right."""

    text: str
    options: tuple[str, ...]
    right: int
    """Index of the right option."""


@dataclass(frozen=True, slots=True)
class Defence:
    """A run of the student's program, and what is asked about it, the easiest first."""

    recording: Recording
    place: Scenario
    questions: tuple[DefenceQuestion, ...]

    @property
    def start(self) -> tuple[float, float, float]:
        """Where the robot starts: x [m], y [m], theta [rad]."""
        x, y, theta = map(float, self.recording.track(self.place.robot or "")[0])
        return x, y, theta

    def right_count(self, answers: Sequence[int]) -> int:
        """How many of the answers, one for each question, are right."""
        return sum(answer == each.right for answer, each in zip(answers, self.questions, strict=True))


def prepare_defence(program: Path, run: Path, seed: int) -> Defence:
    """Runs a program from a start that it has not seen, and makes the questions.

    ``run``: a recording of the program, which says in which world; the start is a place on its way, with another heading.
    ``seed``: of that start, and of the world. Raises DefenceError.
    """
    from kit.controllers import find_controller
    from kit.run.recording import Recorder, RecordingError, load_recording
    from kit.run.scenario import find_scenario
    from kit.run.session import Session

    try:
        before = load_recording(run)
        place = find_scenario(before.place, before.case)
        controller = find_controller(str(program))
    except (OSError, LookupError, RecordingError, WorldError) as error:
        raise DefenceError(str(error)) from None
    robot = place.robot
    if robot is None:
        raise DefenceError(f"{place.title} has no robot that drives.")
    start = _free_start(place, before, robot, seed)
    with Session(place, seed=seed, step_size=before.step_size, always_scan=True) as session:
        recorder = Recorder.for_scenario(place, session.runner.simulation)
        session.runner.observers.append(recorder)
        session.runner.call_service("move_model", robot, start)
        session.drive_with(controller)
        session.wait_until_driven()
        bumps = []
        for _ in range(2):
            run_until(session.runner, limit_s=SECONDS / 2, ends=(when_failed(session),))
            bumps.append(session.metrics.total_bumps)
        if session.failure is not None:
            raise DefenceError(f"Your program stopped: {session.failure}")
        recording = recorder.recording()
    return Defence(recording, place, _questions(recording.track(robot), recording.step_size, bumps))


def _free_start(place: Scenario, before: Recording, robot: str, seed: int) -> tuple[float, float, float]:
    """A pose on the way of an earlier run, with another heading, in which the robot touches nothing."""
    from kit.run.session import Session

    way = before.track(robot)
    if not len(way):
        raise DefenceError("The recorded run is empty.")
    chance = np.random.default_rng(seed)
    first = tuple(map(float, way[0]))
    with Session(place, seed=seed, step_size=before.step_size) as session:

        def touches(pose: tuple[float, ...]) -> bool:
            bumps = session.metrics.total_bumps
            session.runner.call_service("move_model", robot, pose)
            run_until(session.runner, ticks=2)
            return session.metrics.total_bumps > bumps

        for _ in range(STARTS):
            touches(first)  # away from what the start before may have touched
            x, y, _ = map(float, way[chance.integers(len(way))])
            pose = (x, y, float(chance.uniform(-math.pi, math.pi)))
            if not touches(pose):
                return pose
    raise DefenceError("No free start was found on the way of your run.")


def _questions(
    track: np.ndarray[tuple[int, int], np.dtype[np.float64]], step_size: float, bumps: Sequence[int]
) -> tuple[DefenceQuestion, ...]:
    """``track``: (ticks, 3) the robot's poses. ``bumps``: how many until half of the time, and until its end."""
    last = track[-1] - track[-max(2, round(0.5 / step_size))]
    stands = bool(np.hypot(*last[:2]) <= STILL_M and abs(math.remainder(last[2], math.tau)) <= STILL_M)
    turned = np.unwrap(track[:, 2]) - track[0, 2]
    turns = np.flatnonzero(np.abs(turned) >= TURN)
    side = 2 if not len(turns) else 0 if turned[turns[0]] > 0 else 1
    touch = 0 if not bumps[-1] else 1 if bumps[0] else 2
    half = f"{SECONDS / 2:g}"
    return (
        DefenceQuestion(
            f"After {SECONDS:g} s, is it standing still?",
            ("It is standing still.", "It is moving."),
            0 if stands else 1,
        ),
        DefenceQuestion(
            f"Which way does it first turn, by {math.degrees(TURN):.0f} degrees or more?",
            ("To the left.", "To the right.", f"It does not turn so far in {SECONDS:g} s."),
            side,
        ),
        DefenceQuestion(
            "Does it touch anything?",
            ("No.", f"Yes, in the first {half} s.", f"Yes, but not in the first {half} s."),
            touch,
        ),
    )
