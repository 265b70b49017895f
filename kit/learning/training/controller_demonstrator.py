"""A controller as a demonstrator: its ROS 2 node runs in its own process beside a world, and what it commands is noted.

A controller may follow a plan of its own, so it cannot be asked at every moment what it would do: while another drives, its
plan falls behind. Instead it takes over where a policy has driven to, and shows the way from there.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from kit.arrays import Float32Array, FloatArray
from kit.controllers import ControllerFile, controller_title, kit_controllers
from kit.geometry import Pose
from kit.host.sandbox.probe import highest_level_up_to
from kit.host.sandbox.sandbox_config import INTERACTIVE_LEVEL, Level
from kit.learning.policies.policy import Policy
from kit.learning.policies.policy_file import load_policy
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.training.demonstrations import (
    DemonstrationError,
    Demonstrator,
    Examples,
    PolicyDemonstrator,
    PoseObserver,
    RecordedDemonstrator,
    actions_of_twists,
    is_recording,
    join_examples,
)
from kit.msg.geometry_msgs import Twist
from kit.run.episode import run_until
from kit.run.lockstep import Observer
from kit.run.recording import load_recording
from kit.run.scenario import BEACON, Scenario
from kit.run.session import Session
from kit.sim.card_world import load_card_world
from kit.sim.simulation import Simulation
from kit.world.catalogue import MapCard, MapCase

EPISODES_PER_CASE: Final = 3
"""Episodes per case in one demonstration."""


class _CommandListener(Observer):
    """The newest command to each robot, by the topics that its wheels listen to."""

    def __init__(self, session: Session, names: Iterable[str]) -> None:
        self._topics = [session.command_topics(name) for name in names]
        self.twists: FloatArray = np.zeros((len(self._topics), 2))
        """(robots, 2)"""
        self.total: FloatArray = np.zeros_like(self.twists)
        """(robots, 2): the sum over the ticks since it was last set to zero."""

    def on_step(self, simulation: Simulation) -> None:
        self.total += self.twists

    def on_message(self, topic: str, message: Any) -> None:
        for robot, topics in enumerate(self._topics):
            if topic in topics and isinstance(message, Twist):
                self.twists[robot] = message.linear.x, message.angular.z


class ControllerDemonstrator:
    """A controller's file drives episodes of a task."""

    can_be_asked = True

    def __init__(self, file: Path, task: LearningTask) -> None:
        self._controller = ControllerFile(file.stem, file, controller_title(file))
        self._task = task
        is_kits = file.resolve() in {each.file.resolve() for each in kit_controllers()}
        # The run that names it may be somebody else's.
        self._level = INTERACTIVE_LEVEL if is_kits else highest_level_up_to(max(Level))

    def demonstrate(self, policy: Policy | None, seed: int) -> Examples:
        """Its drives from the task's starts; or, given a policy, from places that the policy drives to.

        DemonstrationError if the controller fails.
        """
        cases = self._task.map_cases()
        parts = [
            self._drive_episode(card, number, policy, seed + episode * len(cases) + number)
            for episode in range(EPISODES_PER_CASE)
            for number, (card, _) in enumerate(cases)
        ]
        return join_examples(parts)

    def _drive_episode(self, card: MapCard, case: int, policy: Policy | None, seed: int) -> Examples:
        task, observer = self._task, PoseObserver(self._task, seed)
        seen = observer.begin(case)
        if policy is not None:
            seen = _take_over(observer, policy, seen, seed)
        names = task.robots_on(card)
        observations, twists = [], []
        with Session(_scenario(task, card, names, observer), seed=seed, level=self._level) as session:
            session.drive_with(self._controller)
            session.wait_until_driven()
            listener = _CommandListener(session, names)
            session.runner.observers.append(listener)
            simulation = session.runner.simulation
            ticks = max(1, round(task.step_time / session.runner.step_size))
            for _ in range(task.max_steps):
                listener.total = np.zeros_like(listener.twists)
                run_until(session.runner, ticks=ticks)
                commanded = listener.total / ticks
                if session.failure is not None:
                    raise DemonstrationError(f"{self._controller.file}: {session.failure}")
                if session.metrics.metrics.bumps:
                    break
                observations.append(seen)
                twists.append(commanded)
                poses = dict(zip(simulation.model_names, simulation.poses(), strict=True))
                seen = observer.follow(np.array([poses[name] for name in names]), commanded)
                if observer.has_arrived:
                    break
        if not observations:
            raise DemonstrationError(
                f"{self._controller.file} bumps into something in its first step on {card.name}."
            )
        return Examples(np.concatenate(observations), actions_of_twists(task, np.array(twists)))


def _take_over(observer: PoseObserver, policy: Policy, seen: Float32Array, seed: int) -> Float32Array:
    """Drives an episode with a policy, and goes back to one of the places on its way. Returns what is seen there."""
    player, poses = policy.make_player(1), [observer.state.pose[0].copy()]
    while True:
        step = observer.step(player.act(seen, np.array([len(poses) == 1])))
        seen = step.observations
        if step.ended[0]:
            break
        poses.append(observer.state.pose[0].copy())
    return observer.observe_at(poses[int(np.random.default_rng(seed).integers(len(poses)))])


def _scenario(task: LearningTask, card: MapCard, names: tuple[str, ...], observer: PoseObserver) -> Scenario:
    """The world with its robots where the observer's episode begins."""
    poses = {name: Pose(*pose) for name, pose in zip(names, observer.state.pose[0].tolist(), strict=True)}
    x, y = observer.state.target[0].tolist()
    world = load_card_world(card)
    placed = {**poses, BEACON: Pose(x, y)}
    models = tuple(replace(model, pose=placed.get(model.name, model.pose)) for model in world.models)
    starts = tuple(poses.values())
    episode_case = observer.cases[int(observer.state.case[0])]
    case = MapCase(
        name=episode_case.name,
        start=starts[0],
        target=(x, y),
        target_radius=task.target_radius,
        start_shift=(0.0, 0.0),
        target_shift=(0.0, 0.0),
        is_heading_random=False,
        group="",
        partner_start=starts[1] if len(starts) > 1 else None,
    )
    return Scenario(
        card.name,
        card.title,
        replace(world, models=models),
        names[0],
        case,
        targets=task.route(episode_case),
    )


def read_demonstrator(source: Path, task: LearningTask) -> Demonstrator:
    """The demonstrator in a file: a recording, a policy, or a controller (``.py``).

    Raises DemonstrationError, PolicyError, RecordingError, OSError.
    """
    if source.suffix == ".py":
        return ControllerDemonstrator(source, task)
    if is_recording(source):
        return RecordedDemonstrator(load_recording(source), task, source.name)
    return PolicyDemonstrator(load_policy(source), task)
