"""Demonstrations, as examples to learn from: recorded drives, policies, and (in ``controller_demonstrator``)
controllers. An example is what an agent sees, and what the demonstrator does then.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from kit.arrays import Float32Array, FloatArray
from kit.learning.environment.batch import ALL_WORLDS, BatchEnv
from kit.learning.policies.policy import Policy
from kit.learning.tasks.actions import DiscreteActions
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.transition import average_speeds
from kit.plain_files import open_plain_file
from kit.plain_text import quoted
from kit.run.recording import ACCEPT, Recording

Targets = NDArray[np.generic]
"""Actions of the task's space, one row each."""
STILL_M, STILL_RAD = 1e-3, 1e-3
"""A robot that moves less in a step stands still."""


class DemonstrationError(Exception):
    """A demonstration does not fit the task, or cannot be given; the message says which and what to do."""


@dataclass(frozen=True, slots=True, eq=False)
class Examples:
    """Observations, and the actions that were taken at them."""

    observations: Float32Array
    """(k, size)"""
    actions: Targets
    """(k,), or (k, numbers) where one action is several numbers."""

    def __len__(self) -> int:
        return len(self.observations)


class Demonstrator(Protocol):
    """A driver whose actions are examples to learn from."""

    @property
    def can_be_asked(self) -> bool:
        """Whether it also says what to do where others have driven."""

    def demonstrate(self, policy: Policy | None, seed: int) -> Examples:
        """What it does along its own ways; or, given a policy that drives, what it would do where that one comes to."""


def join_examples(parts: list[Examples]) -> Examples:
    """All of them, one after the other."""
    return Examples(
        np.concatenate([part.observations for part in parts]),
        np.concatenate([part.actions for part in parts]),
    )


def actions_of_twists(task: LearningTask, twists: FloatArray) -> Targets:
    """(k,) or (k, numbers) the actions of a task that are most like the twists (k, robots, 2)."""
    actions, robots = task.actions, task.robots
    if isinstance(actions, DiscreteActions):
        apart = (twists[:, :, None] - actions.twists) / np.maximum(actions.largest, 1e-9)
        return actions.encode(np.square(apart).sum(axis=3).argmin(axis=2), robots)
    low, high = np.array([actions.linear, actions.angular]).T
    shares: Float32Array = np.clip(2.0 * (twists - low) / (high - low) - 1.0, -1.0, 1.0).astype(np.float32)
    return shares.reshape(len(twists), 2 * robots)


class PoseObserver(BatchEnv):
    """One world whose robots are put where something else has driven them, to tell what agents would have seen."""

    def __init__(self, task: LearningTask, seed: int = 0) -> None:
        super().__init__(task, 1, seed, autoreset=False)

    def begin(self, case: int, poses: FloatArray | None = None) -> Float32Array:
        """(1, size) the first observation of an episode. ``poses``: (robots, 3), instead of starts drawn by the task;
        the target is then where the case has it."""
        first = self.reset(cases=np.array([case]))
        if poses is None:
            return first
        self._state.target[0] = self.cases[case].target
        return self.observe_at(poses)

    def observe_at(self, poses: FloatArray) -> Float32Array:
        """(1, size) what robots see that begin at the poses (robots, 3), with the present target."""
        state = self._state = self._state.copy()
        state.pose[0] = poses
        state.speed[:] = state.twist[:] = 0.0
        state.step[:] = 0
        self._note_arrivals()
        return self._observe(ALL_WORLDS, 1, is_fresh=True)

    def follow(self, poses: FloatArray, twists: FloatArray) -> Float32Array:
        """(1, size) what is seen after a step to the poses (robots, 3), for which the twists (robots, 2) were asked."""
        state = self._state = self._state.copy()
        state.speed[:] = average_speeds(state.pose, poses[None], self.task.step_time)
        state.twist[:] = twists
        state.pose[0] = poses
        state.step += 1
        self._note_arrivals()
        return self._observe(ALL_WORLDS, 1, is_fresh=False)

    def twists_to(self, poses: FloatArray) -> FloatArray:
        """(robots, 2) forward [m/s] and turn [rad/s] that lead from the present poses to these (robots, 3)."""
        found: FloatArray = average_speeds(self._state.pose, poses[None], self.task.step_time)[0]
        return found

    @property
    def has_arrived(self) -> bool:
        """Whether every robot is in the target."""
        return self.task.goal.has_standing_targets and bool(self._state.in_target.all())

    def _note_arrivals(self) -> None:
        state = self._state
        state.in_target[:] = self._find_arrivals(state.pose, state.target, state.target_row)


class RecordedDemonstrator:
    """A drive that was recorded: by hand or by a controller (``kit run --record``, a race of ``kit game``)."""

    can_be_asked = False

    def __init__(self, recording: Recording, task: LearningTask, title: str) -> None:
        """DemonstrationError if it was driven somewhere else, or the robots are not those of the task."""
        self._task = task
        self._title = title
        self._case = _case_of(recording, task, title)
        card = task.map_cases()[self._case][0]
        names = task.robots_on(card)
        tracks = [recording.track(name) for name in names]
        missing = [name for name, track in zip(names, tracks, strict=True) if not len(track)]
        if missing:
            raise DemonstrationError(f"{title}: it has no robot {quoted(missing[0])}.")
        ticks = max(1, round(task.step_time / recording.step_size))
        length = min(map(len, tracks))
        poses = np.stack([track[:length] for track in tracks], axis=1)
        poses[:, :, 2] = np.unwrap(poses[:, :, 2], axis=0)
        # Somebody who bumps into a wall may be put back to the start: what led to the wall is not to be learned.
        begun_again = max((entry.tick for entry in recording.inputs if entry.kind != ACCEPT), default=0)
        self._poses: FloatArray = _without_standing(poses[begun_again::ticks])
        if len(self._poses) < 2:
            raise DemonstrationError(f"{title}: nothing moves in it, so there is nothing to learn.")

    def demonstrate(self, policy: Policy | None, seed: int) -> Examples:
        """What was seen and done along the way, up to the target. The noise of the lidar is drawn again."""
        observer = PoseObserver(self._task, seed)
        seen, twists = [observer.begin(self._case, self._poses[0])], []
        for poses in self._poses[1:]:
            twists.append(observer.twists_to(poses))
            seen.append(observer.follow(poses, twists[-1]))
            if observer.has_arrived:
                break
        return Examples(np.concatenate(seen[:-1]), actions_of_twists(self._task, np.array(twists)))


def _case_of(recording: Recording, task: LearningTask, title: str) -> int:
    """The number of the task's case that a recording was driven on."""
    cases = task.map_cases()
    fitting = [
        number
        for number, (card, _) in enumerate(cases)
        if recording.place == card.name or Path(recording.place) == card.world_file
    ]
    if not fitting:
        places = ", ".join(dict.fromkeys(card.name for card, _ in cases))
        raise DemonstrationError(
            f"{title} was driven on {recording.place}; task {task.name} is on {places}. Record a drive there: "
            f"`kit drive {cases[0][0].name} --controller teleop --record FILE.npz`."
        )
    return next((number for number in fitting if cases[number][1].name == recording.case), fitting[0])


def _without_standing(poses: FloatArray) -> FloatArray:
    """The poses (k, robots, 3) from the first movement to the last: waiting for a driver teaches nothing."""
    change = np.abs(np.diff(poses, axis=0))
    moves = (np.hypot(change[:, :, 0], change[:, :, 1]) > STILL_M) | (change[:, :, 2] > STILL_RAD)
    moving = np.flatnonzero(moves.any(axis=1))
    return poses[moving[0] : moving[-1] + 2] if len(moving) else poses[:0]


class PolicyDemonstrator:
    """A trained policy that sees what the learner sees."""

    can_be_asked = True

    def __init__(self, policy: Policy, task: LearningTask, worlds: int = 32) -> None:
        """``worlds``: how many episodes it shows at a time. PolicyError if it does not fit the task."""
        policy.check_fits(task)
        self._policy = policy
        self._task = task
        self._worlds = worlds

    def demonstrate(self, policy: Policy | None, seed: int) -> Examples:
        batch = BatchEnv(self._task, self._worlds, seed, autoreset=False)
        teacher = self._policy.make_player(self._worlds)
        driver = teacher if policy is None else policy.make_player(self._worlds)
        seen = batch.reset()
        fresh, running = np.ones(self._worlds, dtype=np.bool_), np.ones(self._worlds, dtype=np.bool_)
        parts: list[Examples] = []
        while running.any():
            wanted = teacher.act(seen, fresh)
            driven = wanted if driver is teacher else driver.act(seen, fresh)
            parts.append(Examples(seen[running], wanted[running]))
            step = batch.step(driven)
            seen, running = step.observations, running & ~step.ended
            fresh = np.zeros(self._worlds, dtype=np.bool_)
        return join_examples(parts)


def is_recording(file: Path) -> bool:
    """Whether an ``.npz`` file is a recording; else it may be a policy."""
    try:
        with open_plain_file(file) as opened, np.load(opened, allow_pickle=False) as arrays:
            return "header" in arrays.files
    except (OSError, ValueError):
        return False
