"""The tasks as Gymnasium environments, and their pictures."""

from __future__ import annotations

import dataclasses
import math
import sys
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, ClassVar

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.envs.registration import EnvSpec
from numpy.typing import NDArray

from kit.arrays import Float32Array, FloatArray
from kit.geometry import Pose
from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.batch_state import BatchStep
from kit.learning.environment.episode_stats import EpisodeOutcome
from kit.learning.maps.batch_map import BatchMap
from kit.learning.maps.obstacles import Obstacle
from kit.learning.tasks.catalogue import HALLWAY, TURN, WHEELCHAIRS, find_task
from kit.learning.tasks.learning_task import LearningTask, UnknownTask
from kit.learning.tasks.reward import RewardFunction, check_reward
from kit.plain_text import quoted, suggestion
from kit.render.image import draw_image, image_camera
from kit.render.scene import Disc, Scene, SceneBody, Trail
from kit.render.world_text import TerminalPicture, describe_scene, scene_rows
from kit.world.records import Circle, Polygon

Observation = NDArray[np.floating[Any] | np.integer[Any]]
"""float32, which gymnasium's Box does not tell apart."""
ActionArray = NDArray[np.integer[Any] | np.floating[Any]]
Action = int | np.integer[Any] | ActionArray
"""A number of a table of moves, or one for each robot; or the numbers of continuous actions."""

ObservationArray = Float32Array
"""Observations of many worlds."""
IMAGE_SIZE = (480, 480)
TEXT_SIZE = (78, 22)


def resolve_task(task: LearningTask | Path | str | None, default: LearningTask) -> LearningTask:
    """The task meant: itself, that of a name or a file, or ``default``. UnknownTask if there is none; WorldError."""
    if task is None:
        return default
    return task if isinstance(task, LearningTask) else find_task(str(task))


class TaskEnv(gymnasium.Env[Observation, Action]):
    """One world of a task. Subclasses are the registered environments; their docstrings are their task cards."""

    metadata: dict[str, Any] = {"render_modes": ["human", "rgb_array", "ansi"], "render_fps": 5}  # noqa: RUF012 as gymnasium has it
    default_task: ClassVar[LearningTask] = TURN

    def __init__(
        self,
        task: LearningTask | Path | str | None = None,
        *,
        case: str | None = None,
        reward: RewardFunction | None = None,
        render_mode: str | None = None,
    ) -> None:
        """``task``: a variant, such as ``replace(TURN, timeout_terminal=True)`` or ``HALLWAY.on("doors")``; the name of
        a task of the kit's, or the file of one of your own. ``case``: only this case or group of cases.
        ``reward``: instead of the task's own; it gets a transition of one world, in arrays of length 1.
        ``render_mode``: ``human`` paints every step in the terminal, where the last one was, at the robot's own pace;
        ``rgb_array`` and ``ansi`` are what ``render`` returns.

        Raises UnknownTask, UnsupportedWorld, TypeError for a reward that is no function, and WorldError if a task's file is
        wrong."""
        check_render_mode(render_mode)
        check_reward(reward)
        self.task = resolve_task(task, self.default_task)
        if case is not None:
            self.task = self.task.on(case)
        self.render_mode = render_mode
        self.metadata = {**self.metadata, "render_fps": round(1.0 / self.task.step_time)}
        self._picture: TerminalPicture | None = None
        self._paint_at = 0.0
        self._reward = reward
        self._batch: BatchEnv | None = None
        self.observation_space = self.task.observation.space(self.task.robots)
        self.action_space: spaces.Space[Any] = self.task.actions.space(self.task.robots)
        self._trails = [Trail() for _ in range(self.task.robots)]
        self._spec: EnvSpec | None = None

    @property
    def spec(self) -> EnvSpec | None:
        """What ``gymnasium.make`` made it by, with the steps after which an episode of this task is over."""
        return self._spec

    @spec.setter
    def spec(self, spec: EnvSpec | None) -> None:
        self._spec = with_step_limit(spec, self.task.max_steps)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begins an episode. ``options={"case": name}``: on this case, instead of the next one in turn."""
        super().reset(seed=seed)
        batch = self._get_batch(seed)
        check_options(options, "case")
        case = case_number(self.task, (options or {}).get("case"))
        observations = batch.reset(seed, cases=None if case is None else np.array([case]))
        for trail in self._trails:
            trail.clear()
        self._extend_trails()
        if self.render_mode == "human":
            self._paint()
        return observations[0], {"case": batch.cases[int(batch.state.case[0])].name}

    def step(self, action: Action) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """``info``: ``case``; ``terms``, the reward by named term; ``is_success`` and, at the end, ``outcome``."""
        if self._batch is None:
            raise gymnasium.error.ResetNeeded("call reset() before the first step()")
        step = self._batch.step(np.asarray(action)[None])
        self._extend_trails()
        info = step_info(self._batch, step, 0)
        if self.render_mode == "human":
            self._paint()
        ends = bool(step.terminated[0]), bool(step.truncated[0])
        return step.observations[0], float(step.rewards[0]), *ends, info

    def render(self) -> Any:
        """(height, width, 3) uint8 for ``rgb_array``; for ``ansi`` a text: the world in characters, then in words. For
        ``human`` None: every step has been painted."""
        if self.render_mode in (None, "human") or self._batch is None:
            return None
        return picture_of(self._scene(), self.render_mode)

    def _scene(self) -> Scene:
        assert self._batch is not None
        return build_batch_scene(self._batch, 0, tuple(trail.points for trail in self._trails))

    def _paint(self) -> None:
        """Paints the world in the terminal when its time has come: a step takes as long as the robot's."""
        assert self._batch is not None
        self._picture = self._picture or TerminalPicture(sys.stdout)
        time.sleep(max(0.0, self._paint_at - time.monotonic()))
        self._paint_at = time.monotonic() + self.task.step_time
        self._picture.paint(self._scene(), picture_title(self._batch))

    def _get_batch(self, seed: int | None) -> BatchEnv:
        """The world, which is built when it is first needed: an unseeded one by a seed of chance."""
        if self._batch is None:
            seed = int(self.np_random.integers(2**31)) if seed is None else seed
            self._batch = BatchEnv(self.task, 1, seed, reward=self._reward, autoreset=False)
        return self._batch

    def _extend_trails(self) -> None:
        assert self._batch is not None
        for trail, (x, y, _) in zip(self._trails, self._batch.state.pose[0].tolist(), strict=True):
            trail.add(x, y)


def with_step_limit(spec: EnvSpec | None, steps: int) -> EnvSpec | None:
    """The spec, with the steps after which an episode is over where it does not say."""
    if spec is None or spec.max_episode_steps is not None:
        return spec
    return dataclasses.replace(spec, max_episode_steps=steps)


def check_render_mode(mode: str | None) -> None:
    """Raises ValueError for a mode that the environments do not have."""
    modes = TaskEnv.metadata["render_modes"]
    if mode is not None and mode not in modes:
        raise ValueError(f"there is no render mode {quoted(mode)}: {suggestion(mode, modes)}")


def step_info(batch: BatchEnv, step: BatchStep, world: int) -> dict[str, Any]:
    """What there is to know of a world after a step, before it begins another episode."""
    transition = step.transition
    info: dict[str, Any] = {
        "case": batch.cases[int(transition.case[world])].name,
        "terms": {name: float(value[world]) + 0.0 for name, value in step.terms.items()},
        "is_success": bool(transition.reached[world]),
    }
    if batch.task.robots > 1:
        info["adjacent"] = bool(transition.adjacent[world])
    if transition.ended[world]:
        info["outcome"] = EpisodeOutcome.of(transition, world).value
    return info


def picture_of(scene: Scene, mode: str) -> Any:
    """(height, width, 3) uint8 for the mode ``rgb_array``; else a text: the world in characters, then in words."""
    if mode == "rgb_array":
        return draw_image(scene, image_camera(scene.bounds, *IMAGE_SIZE))
    return "\n".join((*scene_rows(scene, *TEXT_SIZE), describe_scene(scene), ""))


def picture_title(batch: BatchEnv) -> str:
    """What stands above a picture of the first world: its case, and how far its episode is."""
    state = batch.state
    return f"{batch.cases[int(state.case[0])].name}, step {int(state.step[0])} of {batch.task.max_steps}"


def check_options(options: Mapping[str, Any] | None, *known: str) -> None:
    """Raises ValueError for an option of ``reset`` that is none: it would be left out without a word."""
    for name in options or ():
        if name not in known:
            raise ValueError(f"reset() has no option {quoted(str(name))}: {suggestion(str(name), known)}")


def case_number(task: LearningTask, case: object) -> int | None:
    """The number of a case by its name; None for None. UnknownTask if there is none."""
    if case is None:
        return None
    names = [each.name for _, each in task.map_cases()]
    if case not in names:
        raise UnknownTask(f"task {task.name} has no case {quoted(str(case))}: {suggestion(str(case), names)}")
    return names.index(str(case))


class TurnEnv(TaskEnv):
    """Round one corner and back again: ``RobotKit/Turn-v0`` (dissertation, section 5.2.2).

    A corridor 0.84 m wide turns by 90 degrees. The robot drives from one end to the other; in the next episode start
    and target change places, so that both a left and a right turn must be learnt.

    Observation: Box (9,) float32. The lidar's 91 rays in 9 sectors, from straight behind over the right, ahead (number
    4) and the left back to straight behind; of each the shortest range [m], at most 2, times 0.5.

    Actions: Discrete (3), each for 0.1 s: forward 0.5 m/s; turn left, turn right 1.57 rad/s.

    Reward: algorithm 3 of the dissertation, times 0.01: forward +1.5, collision -200, target 400 and a point for each
    step left, time out -300 less what moving forward earned.

    Start: within 0.05 m and 0.2 rad of the map's.

    End: terminated by a collision or when the hull is within 0.2 m of the target; truncated after 200 steps.

    ``task=TURN_SEED`` is the dissertation's own: ranges up to 10 m and rewards as they are, no noise at the start, and
    a time out that terminates.
    """

    default_task = TURN


class HallwayEnv(TaskEnv):
    """Fifteen hallways: ``RobotKit/Hallway-v0`` (dissertation, chapter 3).

    Straight on, through doors, round obstacles, round turns and curves of 90 and 180 degrees, to either side. Each
    episode is on the next case; ``task=HALLWAY.on("doors", "straight")`` chooses some, by name or by group.

    Observation: Box (17,) float32, ranges [m], at most 2, times 0.5: the rays ahead, 8 degrees left of it and right of
    it, left, right; then the shortest range of each of 12 sectors: straight behind (60 degrees), behind on the right,
    nine of 20 degrees from right to left, behind on the left.

    Actions: Discrete (7), each for 0.2 s: stop, forward, back (0.3 m/s), left, right (1.05 rad/s), forward and left,
    forward and right.

    Reward: algorithm 1 of the dissertation, times 0.01. Its terms are in ``info``.

    Start: up to 0.3 m to either side, any heading; the target up to 0.3 m to either side.

    End: terminated by a collision or when the hull is within 0.25 m of the target; truncated after 200 steps.

    ``task=HALLWAY_SEED`` is the dissertation's own: rewards as they are, and a time out that terminates.
    """

    default_task = HALLWAY


class WheelchairsEnv(TaskEnv):
    """Two wheelchairs side by side: ``RobotKit/Wheelchairs-v0`` (dissertation, chapter 4).

    One agent drives both, down a corridor and round turns and curves of 90 and 180 degrees, to either side. Each
    episode is on the next case.

    Observation: Box (38,) float32: 19 numbers of the left wheelchair, 19 of the right one. Each: the five rays of
    ``RobotKit/Hallway-v0``, two rays to the side where the other one should be, the 12 sectors; times 6, for a
    centimetre decides whether two are side by side.

    Actions: MultiDiscrete (4, 4), each for 0.2 s: stop, forward 0.3 m/s, left, right 1.05 rad/s.

    Reward: progress of both along the way [m], -0.07 for every step and up to as much back for being side by side, -2
    for a collision, +2 when both are in the target. Its terms are in ``info``, and so is whether the two are adjacent.

    Start: side by side, 0.4 m apart, each within 0.05 m and 0.1 rad.

    End: terminated by a collision or when both are within 0.4 m of the target at the same time; truncated after 300
    steps.

    ``task=WHEELCHAIRS_SEED`` is the dissertation's own: one of 16 actions, algorithm 2, no noise at the start, and a
    time out that terminates; ``WHEELCHAIRS_SEED_49`` its first attempt.
    """

    default_task = WHEELCHAIRS


# Pictures

ROUND_CORNERS = 16
"""A circle is drawn as a polygon of this many corners."""


def build_batch_scene(batch: BatchEnv, world: int, trails: tuple[FloatArray, ...] = ()) -> Scene:
    """Builds the drawing of one world now. ``trails``: (k, 2) per robot, its path so far [m]."""
    state = batch.state
    _, batch_map = batch.map_of_case(int(state.case[world]))
    poses = [Pose(*pose) for pose in state.pose[world].tolist()]
    names = batch_map.robot_names
    bodies = tuple(
        SceneBody(
            name,
            pose,
            tuple(
                np.array([pose.transform_point(*corner) for corner in corners])
                for corners in batch_map.robot.hull
            ),
            is_robot=True,
        )
        for name, pose in zip(names, poses, strict=True)
    )
    x, y = state.target[world].tolist()
    targets = (Disc(x, y, batch.task.target_radius),) if batch.shows_target else ()
    things = tuple(_obstacle_bodies(batch_map, batch.obstacle_poses(world)))
    return Scene(walls=batch_map.walls, bodies=bodies + things, targets=targets, trails=trails)


def lidar_places(batch: BatchEnv, world: int) -> FloatArray:
    """(robots, 3): where the lidars of one world are now [m], and the headings of their robots [rad]."""
    state = batch.state
    _, batch_map = batch.map_of_case(int(state.case[world]))
    lidar = batch_map.robot.lidar
    poses = [Pose(*pose) for pose in state.pose[world].tolist()]
    return np.array([(*pose.transform_point(lidar.x, lidar.y), pose.theta) for pose in poses])


def _obstacle_bodies(batch_map: BatchMap, poses: FloatArray) -> Iterator[SceneBody]:
    for obstacle, place in zip(batch_map.obstacles, poses.tolist(), strict=False):
        pose = Pose(*place)
        if outlines := obstacle_outlines(obstacle, pose):
            yield SceneBody(obstacle.name, pose, outlines, is_robot=False)


def obstacle_outlines(obstacle: Obstacle, pose: Pose) -> tuple[FloatArray, ...]:
    """(k, 2) for each part: the corners of an obstacle that stands at ``pose`` [m]."""
    return tuple(
        np.array([pose.transform_point(*corner) for corner in _outline(part.shape)])
        for part in obstacle.parts
    )


def _outline(shape: Circle | Polygon) -> list[tuple[float, float]]:
    if isinstance(shape, Polygon):
        return list(shape.points)
    (x, y), angles = shape.center, np.linspace(0.0, 2.0 * math.pi, ROUND_CORNERS, endpoint=False)
    return [(x + shape.radius * math.cos(angle), y + shape.radius * math.sin(angle)) for angle in angles]
