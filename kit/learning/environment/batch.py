"""Many worlds of one task as arrays, stepped by compiled loops."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from kit.arrays import Float32Array, FloatArray, IntArray
from kit.kernels import grids, kernels
from kit.kernels.arrays import ScanDraws, StepInputs, StepMoves
from kit.learning.environment.agent_observations import AgentObservations
from kit.learning.environment.batch_loops import BatchLoops
from kit.learning.environment.batch_state import BatchState, BatchStep
from kit.learning.environment.case_arrays import CaseArrays
from kit.learning.environment.disturbance_state import DisturbanceState
from kit.learning.maps.batch_map import BatchMap, axle_twists
from kit.learning.tasks.actions import DiscreteActions, TwistTable
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.reward import Reward, RewardFunction, check_reward
from kit.learning.tasks.reward_terms import FORWARD_SHARE
from kit.learning.tasks.task_case import TaskCase
from kit.learning.tasks.transition import (
    FAR,
    NO_MOVE,
    Array,
    Transition,
    average_speeds,
    distance_to_target,
)
from kit.plain_text import counted
from kit.world.catalogue import MapCard

ALL_WORLDS = slice(None)
NO_BODIES = np.zeros((1, 0, 3))
"""The obstacles of all worlds, where there are none."""

EPISODE_BITS = 32
"""Every episode of a world has 2 to the power of this many random numbers to itself."""
START_DRAWS = 1 << 31
"""Random numbers from here on are for an episode's start, those before for the noise of its scans."""
DISTURBANCE_DRAWS = START_DRAWS + (1 << 24)
"""Random numbers from here on are for an episode's disturbances."""
JITTER_DRAWS = START_DRAWS + (1 << 25)
"""Random numbers from here on are for how late its commands are."""


class RewardError(Exception):
    """A reward function gave something other than one finite number for each world."""


class BatchEnv:
    """``n`` worlds of a task. World i depends on (task, seed, first + i) and its own actions alone: it is the same
    to the bit alone or among many.

    Cases are dealt in turn: episode k of world i runs case number ``first + i + k``, counted round and round, so that
    every case gets equally many episodes; or, if ``fixed_cases``, number ``first + i``, so that they get equally many steps.
    ``reward``: instead of the task's own. ``autoreset``: whether a world whose episode has ended begins its next one
    in the same step; else it waits for ``reset``.
    Raises ValueError for fewer than one world, TypeError for a reward that is no function, and UnsupportedWorld for a map that
    it cannot represent.
    """

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
        if n < 1:
            raise ValueError(f"there must be at least one world, not {n}")
        check_reward(reward)
        self.task = task
        self.n = n
        self.cases: tuple[TaskCase, ...] = tuple(case for _, case in task.map_cases())
        self.observation_space = task.observation.space(task.robots)
        self.action_space = task.actions.space(task.robots)
        self._action_numbers = n * math.prod(self.action_space.shape or ())
        self._reward_function: RewardFunction = task.reward if reward is None else reward
        self._case_arrays = CaseArrays(task)
        self._goal_count = task.goal.make_count(self._case_arrays.goal_cases, n, task.step_time)
        self._needed = self._goal_count.needed
        self._is_share = bool((self._needed == 1.0).all())
        """Whether the goal's count is its share already."""
        self._is_disturbed = bool(task.disturbances)
        self._has_obstacles = self._case_arrays.motions.most > 0
        self._has_leaders = bool((self._case_arrays.leaders >= 0).any())
        self._has_ways = task.goal.has_standing_targets and not self._has_leaders
        self._far = np.full((n, task.robots), FAR)
        self._observations = AgentObservations(task)
        self._loops = BatchLoops(task, self._case_arrays, n, has_ways=self._has_ways)
        self._maps = np.zeros(n, dtype=np.int64)
        """(n,) the map of each world's present case."""
        self._actions = (
            TwistTable(task.actions) if isinstance(task.actions, DiscreteActions) else task.actions
        )
        self._check_times = np.full((1, n), task.step_time / task.collision_checks)
        self._same_command = np.zeros(task.collision_checks, dtype=np.int64)
        self._checks = np.arange(task.collision_checks)
        self._usual_noise, self._no_dropped = np.full(n, self._case_arrays.fleet.noise_std), np.zeros(n)
        self._first_world = first
        self._autoreset = autoreset
        self._assigned: IntArray | None = (first + np.arange(n)) % len(self.cases) if fixed_cases else None
        self._random_keys = self._seed(seed)
        self._state = BatchState.allocate(task, self._loops.allocate_robots(n))
        self._state.episode -= 1  # the first reset leads to number 0

    def __repr__(self) -> str:
        """``BatchEnv(turn, 64 worlds)``"""
        return f"{type(self).__name__}({self.task.name}, {counted(self.n, 'world')})"

    @property
    def state(self) -> BatchState:
        """The present state of all worlds; read only."""
        return self._state

    def map_of_case(self, case: int) -> tuple[MapCard, BatchMap]:
        """The map of a case, by its number."""
        return self._case_arrays.maps[case]

    @property
    def shows_target(self) -> bool:
        """Whether episodes have a target."""
        return self.task.goal.has_standing_targets or self._has_leaders

    def obstacle_poses(self, world: int) -> FloatArray:
        """(k, 3) where the obstacles of a world are now."""
        which = np.array([world])
        found: FloatArray = self._obstacle_poses(which, self._state.step[which])[0]
        return found

    @property
    def has_fixed_cases(self) -> bool:
        """Whether worlds stay with their cases."""
        return self._assigned is not None

    def assign_cases(self, shares: FloatArray) -> None:
        """Shares out again the worlds that stay with their cases: ``shares`` (cases,), which add up to 1. As few as possible
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

    def reset(self, seed: int | None = None, *, cases: IntArray | None = None) -> Float32Array:
        """(n, size) the first observations of new episodes, in every world.

        ``seed``: starts everything again, else the worlds go on to their next episodes. ``cases``: (n,) numbers
        of the cases that these episodes run, instead of those dealt in turn; -1: the one dealt.
        """
        self._state = self._state.copy()
        if seed is not None:
            self._random_keys = self._seed(seed)
            self._state.episode[:] = 0
        else:
            self._state.episode += 1
        self._begin_episodes(np.arange(self.n), cases)
        return self._observe(ALL_WORLDS, self.n, is_fresh=True)

    def _seed(self, seed: int) -> IntArray:
        """(n,) where each world's randomness comes from."""
        keys = [int(kernels.random_bits(seed, self._first_world + i)) >> 1 for i in range(self.n)]
        return np.array(keys, dtype=np.int64)

    def _begin_episodes(self, which: IntArray, cases: IntArray | None = None) -> None:
        """Puts the worlds ``which`` at the start of their present episodes. The state's arrays must be nobody else's."""
        state, case_arrays = self._state, self._case_arrays
        turns = (self._first_world + which + state.episode[which]) % len(self.cases)
        dealt = turns if self._assigned is None else self._assigned[which]
        wanted = dealt if cases is None else np.asarray(cases, dtype=np.int64)[which]
        case = np.where(wanted < 0, dealt, wanted)
        start = case_arrays.draw_starts(
            case, self._random_keys[which], (state.episode[which] << EPISODE_BITS) + START_DRAWS
        )
        state.case[which] = case
        self._maps[which] = case_arrays.map_of[case]
        state.target_row[which] = start.rows
        state.phase[which] = start.phases if self.task.random_phase else 0.0
        state.step[which] = 0
        state.target[which] = self._first_targets(which, start.targets)
        state.target_heading[which] = case_arrays.targets[start.rows, 2]
        state.pose[which] = start.poses
        state.robots.clearance[which] = 0.0
        state.to_go[which] = self._measure_ways(start.poses, start.rows, state.target[which])
        state.rotation[which] = 0.0
        state.forward_steps[which] = 0.0
        state.move[which] = NO_MOVE
        state.twist[which] = 0.0
        state.speed[which] = 0.0
        state.in_target[which] = self._find_arrivals(start.poses, state.target[which], start.rows)
        state.count[which] = self._goal_count.begin(which, case, start.poses)
        state.achieved[which] = state.count[which] / self._needed[case]
        state.told_achieved[which] = state.achieved[which]
        first = (state.episode[which] << EPISODE_BITS) + DISTURBANCE_DRAWS
        state.disturbed.begin(which, self._random_keys[which], first)

    # One step

    def step(self, actions: NDArray[np.generic]) -> BatchStep:
        """Every world does one step; ``actions``: (n,), or (n, numbers) where one action is several numbers.

        Raises ValueError for actions that are not in the space, and RewardError.
        """
        if len(actions) != self.n or np.size(actions) != self._action_numbers:
            shape = (self.n, *(self.action_space.shape or ()))
            raise ValueError(
                f"{counted(self.n, 'world')} must get actions of shape {shape}, not {np.shape(actions)}"
            )
        transition = self._simulate(actions)
        observations = self._observe_step()
        terminated, truncated = self.task.endings(transition)
        over = transition.ended.nonzero()[0]
        last_observations = observations[over]
        if len(over) and self._autoreset:
            observations[over] = self.reset_worlds(over)
        rewards, terms = self._reward(transition)
        return BatchStep(observations, rewards, terminated, truncated, last_observations, transition, terms)

    def _simulate(self, actions: NDArray[np.generic]) -> Transition:
        """Moves every world, scans, and counts what it has achieved."""
        before, commands = self._state, self._actions.commands(actions, self.task.robots)
        twists = np.ascontiguousarray(commands.twists)
        disturbed, moves = self._drive(axle_twists(twists, self._case_arrays.robot.wheelbase))
        bodies, step = self._bodies_at_checks(), before.step + 1
        target = self._follow_leaders(before.target, bodies[-1])
        draws = self._scan_draws(ALL_WORLDS, self.n, before.episode, step, disturbed)
        inputs = StepInputs(self._maps, moves, bodies, before.target_row, target, draws)
        robots = self._loops.step(before.robots, inputs)
        after = before.changed(
            robots=robots._replace(
                to_go=self._limited_ways(robots.to_go, robots.pose, target),
                in_target=self.task.goal.is_arrived(robots.in_target, robots.pose, before.target_heading),
            ),
            step=step,
            target=target,
            forward_steps=before.forward_steps + FORWARD_SHARE.take(commands.moves, mode="clip"),
            move=commands.moves,
            twist=twists,
            speed=self._measure_speeds(before.pose, robots.pose),
            obstacle_distance=self._nearest_obstacles(bodies[-1], robots.pose),
            disturbed=disturbed,
        )
        transition = Transition(before, after, self.task.max_steps, self.task.collision_ending != "continues")
        self._count(transition, after)
        self._state = self._with_next_targets(before, after)
        return transition

    def _count(self, transition: Transition, after: BatchState) -> None:
        """Counts in the state after a step what it has achieved."""
        after.count = self._goal_count.count(transition)
        after.achieved = after.count if self._is_share else after.count / self._needed[after.case]
        after.told_achieved = (
            transition.previous_achieved if self.task.goal.is_observation_delayed else after.achieved
        )

    def _drive(self, twists: FloatArray) -> tuple[DisturbanceState, StepMoves]:
        """The state of the disturbances once ``twists`` are sent, and how the robots move in this step."""
        task, old = self.task, self._state
        if not self._is_disturbed:
            turn = twists[:, :, 1] * task.step_time
            return old.disturbed, StepMoves(
                twists[None], self._check_times, self._same_command, self._checks, turn
            )
        number = (old.episode << EPISODE_BITS) + JITTER_DRAWS + old.step * task.robots
        disturbed = old.disturbed.after_command(twists, self._random_keys, number)
        return disturbed.moves(task.collision_checks)

    def _measure_speeds(self, before: FloatArray, after: FloatArray) -> FloatArray:
        """(n, robots, 2) of this step, where agents are told; else what it was."""
        if not self.task.observation.speeds:
            return self._state.speed
        speeds: FloatArray = average_speeds(before, after, self.task.step_time)
        return speeds

    def reset_worlds(
        self, which: IntArray, *, seeds: Sequence[int | None] | None = None, cases: IntArray | None = None
    ) -> Float32Array:
        """Begins the next episodes of the worlds ``which`` (m); (m, size) what agents see of them.

        ``seeds``: (m) each begins a world's randomness anew, as that of a single world with this seed; None goes on.
        ``cases``: (n,) numbers of the cases that all worlds would run, instead of those dealt in turn; -1: the one dealt.
        """
        self._state = self._state.copy()
        self._state.episode[which] += 1
        if seeds is not None:
            self._random_keys = self._random_keys.copy()
            for world, seed in zip(which.tolist(), seeds, strict=True):
                if seed is not None:
                    self._random_keys[world] = int(kernels.random_bits(seed, 0)) >> 1
                    self._state.episode[world] = 0
        self._begin_episodes(which, cases)
        return self._observe(which, len(which), is_fresh=True)

    # Things that move, and targets

    def _obstacle_poses(self, which: IntArray | slice, steps: Array) -> FloatArray:
        """(m, k, 3) where the obstacles of the worlds ``which`` are after this many steps (m)."""
        if not self._has_obstacles:
            return NO_BODIES
        state, motions = self._state, self._case_arrays.motions
        maps = self._case_arrays.map_of[state.case[which]]
        times: Array = steps * self.task.step_time
        return motions.poses(maps, times, state.phase[which])

    def _bodies_at_checks(self) -> FloatArray:
        """(checks, n, k, 3) where the obstacles of all worlds are at each check of this step."""
        if not self._has_obstacles:
            return NO_BODIES[None]
        parts: Array = (self._checks + 1) / len(self._checks)
        return np.stack([self._obstacle_poses(ALL_WORLDS, self._state.step + part) for part in parts])

    def _nearest_obstacles(self, bodies: FloatArray, poses: FloatArray) -> FloatArray:
        """(n, robots) [m], FAR where there is none."""
        if not self._has_obstacles:
            return self._far
        nearest = np.full(poses.shape[:2], FAR)
        maps = self._case_arrays.map_of[self._state.case]
        grids.find_nearest_obstacles(self._case_arrays.obstacles, maps, bodies, poses, nearest)
        return nearest

    def _first_targets(self, which: IntArray, targets: FloatArray) -> FloatArray:
        """(m, 2) the targets of the worlds ``which`` at the start of their episodes, of which ``targets`` (m, 2) stand."""
        if not self._has_leaders:
            return targets
        return self._follow_leaders(targets, self._obstacle_poses(which, self._state.step[which]), which)

    def _follow_leaders(
        self, targets: FloatArray, bodies: FloatArray, which: IntArray | slice = ALL_WORLDS
    ) -> FloatArray:
        """(m, 2) the targets of the worlds ``which``, those that move where ``bodies`` (m, k, 3) are."""
        if not self._has_leaders:
            return targets
        leaders = self._case_arrays.leaders[self._state.case[which]]
        places = bodies[np.arange(len(leaders)), np.maximum(leaders, 0), :2]
        return np.where((leaders >= 0)[:, None], places, targets)

    def _measure_ways(self, poses: FloatArray, rows: IntArray, targets: FloatArray) -> FloatArray:
        """(m, robots) the ways to the targets ``rows`` (m), which lie at ``targets`` (m, 2)."""
        found = self._loops.measure_ways(rows, poses) if self._has_ways else self._far
        return self._limited_ways(found, poses, targets)

    def _limited_ways(self, found: FloatArray, poses: FloatArray, targets: FloatArray) -> FloatArray:
        """(m, robots) the ways to targets that tables have ``found``; straight ones to a target that moves, none where there is
        no target."""
        if self._has_ways:
            return np.maximum(found, self.task.path_end)
        if self.task.goal.needs_target:
            distances: FloatArray = distance_to_target(poses, targets)
            return distances
        return np.zeros(poses.shape[:2])

    def _find_arrivals(self, poses: FloatArray, targets: FloatArray, rows: IntArray) -> Array:
        """(m, robots) who is in the target ``rows`` (m), which lies at ``targets`` (m, 2)."""
        inside = self._loops.find_arrivals(poses, targets)
        return self.task.goal.is_arrived(inside, poses, self._case_arrays.targets[rows, 2])

    def _with_next_targets(self, before: BatchState, after: BatchState) -> BatchState:
        """The state that the next step begins with: where a route's target was reached, with the next one."""
        if not self.task.goal.is_route:
            return after
        which = np.flatnonzero(np.floor(after.count) > np.floor(before.count))
        if not len(which):
            return after
        case_arrays, cases = self._case_arrays, after.case[which]
        place = after.count[which].astype(np.int64) % case_arrays.target_count[cases]
        rows = case_arrays.target_first[cases] + place
        going_on = after.copy()
        going_on.target_row[which], going_on.target[which] = rows, case_arrays.targets[rows, :2]
        going_on.to_go[which] = case_arrays.to_go(rows, after.pose[which])
        going_on.in_target[which] = self._find_arrivals(after.pose[which], going_on.target[which], rows)
        return going_on

    # What agents see and earn

    def _observe_step(self) -> Float32Array:
        """(n, size) what agents see of all worlds after a step."""
        return self._observations.complete(
            self._state.robots.readings, self._state, ALL_WORLDS, is_fresh=False
        )

    def _observe(self, which: IntArray | slice, m: int, *, is_fresh: bool) -> Float32Array:
        """(m, size) what agents see of the worlds ``which`` (m) as they are; ``is_fresh``: whether their episodes have just begun."""
        state = self._state
        draws = self._scan_draws(which, m, state.episode[which], state.step[which], state.disturbed)
        bodies = self._obstacle_poses(which, state.step[which])
        scan = self._loops.scan(self._maps[which], state.pose[which], draws, bodies)
        return self._observations.complete(scan.frame, state, which, is_fresh=is_fresh)

    def _scan_draws(
        self,
        which: IntArray | slice,
        m: int,
        episodes: IntArray,
        steps: IntArray,
        disturbed: DisturbanceState,
    ) -> ScanDraws:
        """The random part of the scans of the worlds ``which`` (m) after ``steps`` (m) steps of ``episodes`` (m)."""
        keys, numbers = self._random_keys[which], (episodes << EPISODE_BITS) + steps * self.task.robots
        if not self._is_disturbed:
            return ScanDraws(keys, numbers, self._usual_noise[:m], self._no_dropped[:m])
        noise = disturbed.noise_std(self._case_arrays.fleet.noise_std, which)
        return ScanDraws(keys, numbers, noise, disturbed.dropped(which))

    def _reward(self, transition: Transition) -> tuple[Float32Array, dict[str, Array]]:
        """(n,) rewards, and what each term adds; of code from outside its metrics."""
        if isinstance(self._reward_function, Reward):
            terms = self._reward_function.terms(transition)
            return np.asarray(sum(terms.values()), dtype=np.float32), terms
        returned = self._reward_function(transition)
        if returned is None:
            raise RewardError(
                "the reward function returned nothing: does every path through it end with a return?"
            )
        rewards = self._check_values(np.asarray(returned), "reward")
        count_metrics = getattr(self._reward_function, "metrics", None)  # of a student's file
        metrics = {} if count_metrics is None else count_metrics(transition)
        return rewards, {
            name: self._check_values(values, f"metric {name}") for name, values in metrics.items()
        }

    def _check_values(self, values: Array, name: str) -> Float32Array:
        """(n,) what code from outside gave, in single precision. RewardError unless it is a finite number for each world."""
        if values.shape != (self.n,) or values.dtype.kind not in "fiub":
            raise RewardError(
                f"the {name} must be an array of numbers, one for each world, of shape ({self.n},): this has the shape "
                f"{values.shape} and the type {values.dtype}. The fields of its record are such arrays; "
                "numpy.full(len(step.reached), 1.0) is a constant one"
            )
        numbers: Float32Array = values.astype(np.float32)
        if not np.isfinite(numbers).all():
            raise RewardError(
                f"the {name} is {numbers[~np.isfinite(numbers)][0]}: it must be a finite number"
            )
        return numbers
