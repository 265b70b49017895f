"""Many worlds of one task as arrays, stepped by compiled loops."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from kit.kernels import kernels
from kit.learning.environment.actions import Commands
from kit.learning.environment.batch_map import BatchMap
from kit.learning.environment.case_arrays import CaseArrays
from kit.learning.environment.disturbance_state import DisturbanceState
from kit.learning.environment.observations import MAX_COORDINATE, MAX_TARGET_DISTANCE, RAY_COUNT
from kit.learning.environment.rewards import FORWARD_SHARE, Reward, RewardFunction
from kit.learning.environment.tasks import LearningTask
from kit.learning.environment.transition import Array, Transition, bearing_of_target, distance_to_target
from kit.learning.tasks.learning_task import TaskCase
from kit.world.catalogue import MapCard

FloatArray = NDArray[np.float64]
SingleArray = NDArray[np.float32]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

ALL_WORLDS = slice(None)
NO_MOVE = -1
FULL_TURN = 2.0 * np.pi

EPISODE_BITS = 32
"""Every episode of a world has 2 to the power of this many random numbers to itself."""
START_DRAWS = 1 << 31
"""Random numbers from here on are for an episode's start, those before for the noise of its scans."""
DISTURBANCE_DRAWS = START_DRAWS + (1 << 24)
"""Random numbers from here on are for an episode's disturbances."""
JITTER_DRAWS = START_DRAWS + (1 << 25)
"""Random numbers from here on are for how late its commands are."""
SCAN_LENGTH = -(-RAY_COUNT // 32) * 32
"""A scan's room: whole vectors of numbers are faster. What follows the last ray is the reach."""


class RewardError(Exception):
    """A reward function gave something else than one finite number for each world."""


@dataclass(frozen=True, slots=True, eq=False)
class BatchStep:
    """The results of one step of all worlds. A world whose episode has ended is in its next one already.

    The arrays are the caller's to keep.
    """

    observations: SingleArray
    """(n, size): of the running episodes."""
    rewards: SingleArray
    """(n,)"""
    terminated: BoolArray
    """(n,)"""
    truncated: BoolArray
    """(n,)"""
    final_observations: SingleArray
    """(n, size): what was seen before the reset; equal to ``observations`` where nothing has ended."""
    transition: Transition
    """The transitions of n worlds, before the reset."""
    terms: dict[str, Array]
    """(n,) each: the reward by named term; empty for a student's reward."""

    @property
    def ended(self) -> BoolArray:
        """(n,)"""
        return self.terminated | self.truncated


@dataclass(slots=True, eq=False)
class BatchState:
    """The state of ``n`` worlds with r robots each. A step makes a new one; only a reset writes into it."""

    episode: IntArray
    """(n,)"""
    case: IntArray
    """(n,)"""
    target: FloatArray
    """(n, 2)"""
    step: IntArray
    """(n,) steps of this episode so far."""
    pose: FloatArray
    """(n, r, 3)"""
    clearance: FloatArray
    """(n, r): no wall is nearer [m], for sure; 0 where unknown."""
    to_go: FloatArray
    """(n, r)"""
    rotation: FloatArray
    """(n, r) rad, since the robot last turned to the other side."""
    forward_steps: FloatArray
    """(n, r)"""
    move: IntArray
    """(n, r) the last one, NO_MOVE at the start."""
    twist: FloatArray
    """(n, r, 2) what the last action asked for, forward [m/s] and turn [rad/s]; 0 at the start."""
    speed: FloatArray
    """(n, r, 2) how fast the robots really moved in the last step; only where agents are told."""
    frames: SingleArray
    """(n, frames - 1, size): what agents saw before, where they see more than one frame."""
    in_target: BoolArray
    """(n, r)"""
    disturbed: DisturbanceState

    @classmethod
    def allocate(cls, task: LearningTask, n: int) -> BatchState:
        """Arrays for ``n`` worlds of a task, all zero, without a last move."""
        robots, seen = task.robots, task.observation
        shape = n, robots
        return cls(
            episode=np.zeros(n, dtype=np.int64),
            case=np.zeros(n, dtype=np.int64),
            target=np.zeros((n, 2)),
            step=np.zeros(n, dtype=np.int64),
            pose=np.zeros((n, robots, 3)),
            clearance=np.zeros(shape),
            to_go=np.zeros(shape),
            rotation=np.zeros(shape),
            forward_steps=np.zeros(shape),
            move=np.full(shape, NO_MOVE, dtype=np.int64),
            twist=np.zeros((*shape, 2)),
            speed=np.zeros((*shape, 2)),
            frames=np.zeros((n, seen.frames - 1, robots * seen.frame_size), dtype=np.float32),
            in_target=np.zeros(shape, dtype=np.bool_),
            disturbed=DisturbanceState.allocate(task, n),
        )

    def copy(self) -> BatchState:
        return BatchState(*(getattr(self, field.name).copy() for field in fields(self)))


class BatchEnv:
    """``n`` worlds of a task. World i depends on (task, seed, first + i) and its own actions alone: it is the same
    to the bit alone or among many.

    Cases are dealt in turn: episode k of world i runs case number ``first + i + k``, counted round and round, so that
    every case gets equally many episodes; or, if ``fixed_cases``, number ``first + i``, so that they get equally many steps.
    ``reward``: instead of the task's own. ``autoreset``: whether a world whose episode has ended begins its next one
    in the same step; else it waits for ``reset``. Raises UnsupportedWorld for a map that it cannot represent.
    """

    render_mode: None = None
    """A batch draws nothing; ``kit.learning.environment.env`` draws one world."""

    def __init__(
        self,
        task: LearningTask,
        n: int,
        seed: int = 0,
        *,
        reward: RewardFunction | None = None,
        first: int = 0,
        autoreset: bool = True,
        fixed_cases: bool = False,
    ) -> None:
        self.task = task
        self.n = n
        self.cases: tuple[TaskCase, ...] = tuple(case for _, case in task.map_cases())
        self.observation_space = task.observation.space(task.robots)
        self.action_space = task.actions.space(task.robots)
        self._reward_function: RewardFunction = task.reward if reward is None else reward
        self._case_arrays = CaseArrays(task)
        self._single_rays, self._sectors = task.observation.ray_tables(task.robots)
        self._parts = task.observation.part_slices()
        self._first_world = first
        self._autoreset = autoreset
        self._assigned: IntArray | None = (first + np.arange(n)) % len(self.cases) if fixed_cases else None
        self._random_keys = self._seed(seed)
        self._state = BatchState.allocate(task, n)
        self._state.episode -= 1  # the first reset leads to number 0

    @property
    def state(self) -> BatchState:
        """The present state of all worlds; read only."""
        return self._state

    def map_of_case(self, case: int) -> tuple[MapCard, BatchMap]:
        """The map of a case, by its number."""
        return self._case_arrays.maps[case]

    @property
    def has_fixed_cases(self) -> bool:
        """Whether worlds stay with their cases."""
        return self._assigned is not None

    def assign_cases(self, shares: FloatArray) -> None:
        """Shares out anew the worlds that stay with their cases: ``shares`` (cases,), which add up to 1. As few as possible
        change, each when its episode is over. ValueError where worlds do not stay."""
        if self._assigned is None:
            raise ValueError("worlds that take the cases in turn cannot be dealt")
        exact = np.asarray(shares) * self.n
        wanted = np.floor(exact).astype(np.int64)
        wanted[np.argsort(wanted - exact, kind="stable")[: self.n - wanted.sum()]] += 1
        assigned, released = self._assigned.copy(), []
        for world, case in enumerate(assigned):
            wanted[case] -= 1
            if wanted[case] < 0:
                released.append(world)
        assigned[released] = np.repeat(np.arange(len(wanted)), np.maximum(wanted, 0))
        self._assigned = assigned

    # Beginning

    def reset(self, seed: int | None = None, *, cases: IntArray | None = None) -> SingleArray:
        """(n, size) the first observations of new episodes, in every world.

        ``seed``: starts everything anew, else the worlds go on to their next episodes. ``cases``: (n,) numbers
        of the cases that these episodes run, instead of those dealt in turn.
        """
        self._state = self._state.copy()
        if seed is not None:
            self._random_keys = self._seed(seed)
            self._state.episode[:] = 0
        else:
            self._state.episode += 1
        self._begin_episodes(np.arange(self.n), cases)
        return self._observe(ALL_WORLDS, is_fresh=True)[1]

    def _seed(self, seed: int) -> IntArray:
        """(n,) where each world's randomness comes from."""
        keys = [int(kernels.random_bits(seed, self._first_world + i)) >> 1 for i in range(self.n)]
        return np.array(keys, dtype=np.int64)

    def _begin_episodes(self, which: IntArray, cases: IntArray | None = None) -> None:
        """Puts the worlds ``which`` at the start of their present episodes."""
        state, case_arrays = self._state, self._case_arrays
        turns = (self._first_world + which + state.episode[which]) % len(self.cases)
        dealt = turns if self._assigned is None else self._assigned[which]
        case = dealt if cases is None else np.asarray(cases, dtype=np.int64)[which]
        start = case_arrays.draw_starts(
            case, self._random_keys[which], (state.episode[which] << EPISODE_BITS) + START_DRAWS
        )
        state.case[which] = case
        state.target[which] = start.targets
        state.step[which] = 0
        state.pose[which] = start.poses
        state.clearance[which] = 0.0
        state.to_go[which] = case_arrays.to_go(case, start.poses)
        state.rotation[which] = 0.0
        state.forward_steps[which] = 0.0
        state.move[which] = NO_MOVE
        state.twist[which] = 0.0
        state.speed[which] = 0.0
        state.in_target[which] = self._is_in_target(start.poses, start.targets)
        first = (state.episode[which] << EPISODE_BITS) + DISTURBANCE_DRAWS
        state.disturbed.begin(which, self._random_keys[which], first)

    # One step

    def step(self, actions: NDArray[np.generic]) -> BatchStep:
        """Every world does one step; ``actions``: (n,), or (n, numbers) where one action is several numbers.

        Raises ValueError for actions that are not in the space, and RewardError.
        """
        if len(actions) != self.n:
            raise ValueError(f"{self.n} worlds want {self.n} actions, not {len(actions)}")
        transition, final = self._simulate(self.task.actions.commands(actions, self.task.robots))
        rewards, terms = self._reward(transition)
        terminated, truncated = transition.collided | transition.reached, transition.timed_out
        if self.task.timeout_terminal:
            terminated, truncated = terminated | truncated, np.zeros_like(truncated)
        over = np.flatnonzero(transition.ended)
        observations = self._reset_done(over, final) if len(over) and self._autoreset else final
        return BatchStep(observations, rewards, terminated, truncated, final, transition, terms)

    def _simulate(self, commands: Commands) -> tuple[Transition, SingleArray]:
        """Moves every world by these commands; what happened, and what agents see then."""
        task, case_arrays, old = self.task, self._case_arrays, self._state
        pose, clearance, hit = (
            old.pose.copy(),
            old.clearance.copy(),
            np.zeros(old.clearance.shape, dtype=np.bool_),
        )
        number = (old.episode << EPISODE_BITS) + JITTER_DRAWS + old.step
        disturbed = old.disturbed.after_command(commands.twists, self._random_keys, number)
        turn = self._drive(disturbed, pose, clearance, hit)
        move = commands.moves
        self._state = new = BatchState(
            episode=old.episode,
            case=old.case,
            target=old.target,
            step=old.step + 1,
            pose=pose,
            clearance=clearance,
            to_go=case_arrays.to_go(old.case, pose),
            rotation=np.where(old.rotation * turn < 0.0, turn, old.rotation + turn),
            forward_steps=old.forward_steps + FORWARD_SHARE[move],
            move=move,
            twist=commands.twists,
            speed=self._speeds(old.pose, pose) if task.observation.speeds else old.speed,
            frames=old.frames,
            in_target=self._is_in_target(pose, old.target),
            disturbed=disturbed,
        )
        ranges, seen = self._observe(ALL_WORLDS, is_fresh=False)
        transition = Transition(
            case=new.case,
            step=new.step,
            max_steps=task.max_steps,
            hit=hit,
            in_target=new.in_target,
            was_in_target=old.in_target,
            move=new.move,
            previous_move=old.move,
            pose=new.pose,
            previous_pose=old.pose,
            target=new.target,
            to_go=new.to_go,
            previous_to_go=old.to_go,
            full_turns=(np.abs(new.rotation) / FULL_TURN).astype(np.int64),
            forward_steps=new.forward_steps,
            ranges=ranges[:, :, :RAY_COUNT],
        )
        return transition, seen

    def _drive(
        self, disturbed: DisturbanceState, pose: FloatArray, clearance: FloatArray, hit: BoolArray
    ) -> FloatArray:
        """Moves the robots in place for one step, by the commands that reach their wheels. Returns (n, robots), how far
        these turn them [rad]."""
        task, fleet = self.task, self._case_arrays.fleet
        maps, length = self._case_arrays.map_of[self._state.case], task.step_time / task.collision_checks
        turn = np.zeros(clearance.shape)
        for check in range(task.collision_checks):
            durations = disturbed.durations(check * length, length)
            for age in reversed(range(durations.shape[1])):
                lasts, twists = np.ascontiguousarray(durations[:, age]), disturbed.commands[:, age]
                if lasts.any():
                    kernels.step_worlds(
                        fleet, maps, np.ascontiguousarray(twists), lasts, pose, clearance, hit
                    )
                    turn += twists[:, :, 1] * lasts[:, None]
        return turn

    def _speeds(self, before: FloatArray, after: FloatArray) -> FloatArray:
        """(n, robots, 2) forward [m/s] and turn [rad/s] that led from one pose (n, robots, 3) to the other, on average."""
        (dx, dy, turn), middle = np.moveaxis(after - before, 2, 0), 0.5 * (before[:, :, 2] + after[:, :, 2])
        forward = dx * np.cos(middle) + dy * np.sin(middle)
        return np.stack([forward, turn], axis=2) / self.task.step_time

    def _reset_done(self, over: IntArray, final: SingleArray) -> SingleArray:
        """The observations, with those of the next episodes of the worlds ``over``."""
        self._state = self._state.copy()
        self._state.episode[over] += 1
        self._begin_episodes(over)
        observations = final.copy()
        observations[over] = self._observe(over, is_fresh=True)[1]
        return observations

    def _is_in_target(self, poses: FloatArray, targets: FloatArray) -> BoolArray:
        """(m, robots): who is in the target."""
        task, inside = self.task, np.empty(poses.shape[:2], dtype=np.bool_)
        kernels.find_arrivals(
            self._case_arrays.fleet, poses, targets, task.target_radius, task.measured_to == "hull", inside
        )
        return inside

    # What agents see and earn

    def _observe(self, which: IntArray | slice, *, is_fresh: bool) -> tuple[SingleArray, SingleArray]:
        """(m, robots, rays) what the lidars of the worlds ``which`` read, as far as agents see, and (m, size) what agents
        see of it."""
        seen, state, case_arrays = self.task.observation, self._state, self._case_arrays
        maps, poses = case_arrays.map_of[state.case[which]], state.pose[which]
        ranges = np.empty((*poses.shape[:2], SCAN_LENGTH), dtype=np.float32)
        sensed = np.empty((*poses.shape[:2], seen.frame_size), dtype=np.float32)
        drawn = (state.episode[which] << EPISODE_BITS) + state.step[which] * ranges.shape[1]
        kernels.scan_worlds(
            case_arrays.fleet,
            maps,
            poses,
            self._random_keys[which],
            drawn,
            state.disturbed.noise_std(case_arrays.fleet.noise_std, which),
            state.disturbed.dropped(which),
            seen.clip,
            self._single_rays,
            self._sectors,
            ranges,
            sensed,
        )
        sensed *= np.float32(seen.scale)
        for name, place in self._parts.items():
            sensed[:, :, place] = self._part(name, which)
        frame = sensed.reshape(len(sensed), -1)
        return ranges, frame if seen.frames == 1 else self._stacked(frame, which, is_fresh=is_fresh)

    def _part(self, name: str, which: IntArray | slice) -> Array:
        """(m, robots, size) the numbers of one part of the observation."""
        state, scale = self._state, self.task.observation.scale
        pose, target = state.pose[which], state.target[which]
        match name:
            case "target":
                distance = np.minimum(distance_to_target(pose, target), MAX_TARGET_DISTANCE) * scale
                return np.stack([distance, bearing_of_target(pose, target) / np.pi], axis=2)
            case "arrived":
                return state.in_target[which][:, :, None]
            case "speeds":
                return state.speed[which]
            case "last_action":
                return state.twist[which]
            case "own_pose":
                place = np.clip(pose[:, :, :2], -MAX_COORDINATE, MAX_COORDINATE) * scale
                heading = pose[:, :, 2:]
                return np.concatenate([place, np.cos(heading), np.sin(heading)], axis=2)
            case _:
                raise AssertionError(name)  # a part without numbers is a mistake in this class

    def _stacked(self, frame: SingleArray, which: IntArray | slice, *, is_fresh: bool) -> SingleArray:
        """(m, frames * size) the last frames, the newest last; of a fresh episode all are its first one."""
        state, count = self._state, self.task.observation.frames
        past = np.repeat(frame[:, None], count - 1, axis=1) if is_fresh else state.frames[which]
        stack = np.concatenate([past, frame[:, None]], axis=1)
        kept = state.frames.copy()
        kept[which] = stack[:, 1:]
        state.frames = kept
        return stack.reshape(len(frame), -1)

    def _reward(self, transition: Transition) -> tuple[SingleArray, dict[str, Array]]:
        """(n,) rewards, and what each term adds."""
        if isinstance(self._reward_function, Reward):
            terms = self._reward_function.terms(transition)
            return np.asarray(sum(terms.values()), dtype=np.float32), terms
        rewards = np.asarray(self._reward_function(transition))
        if rewards.shape != (self.n,) or rewards.dtype.kind not in "fiub":
            raise RewardError(
                f"the reward must be {self.n} numbers, one for each world: this is an array of shape "
                f"{rewards.shape} and type {rewards.dtype}"
            )
        rewards = rewards.astype(np.float32)
        if not np.isfinite(rewards).all():
            raise RewardError(
                f"the reward is {rewards[~np.isfinite(rewards)][0]}: it must be a finite number"
            )
        return rewards, {}
