"""Many worlds of one task as arrays, stepped by compiled loops."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kit.arrays import BoolArray, Float32Array, FloatArray, IntArray
from kit.kernels import grids, kernels
from kit.kernels.arrays import StepInputs, StepMoves
from kit.learning.environment.batch_loops import BatchLoops
from kit.learning.environment.batch_state import NO_MOVE, BatchState, BatchStep, DisturbanceState
from kit.learning.environment.case_arrays import CaseArrays, GoalCount
from kit.learning.maps.batch_map import BatchMap
from kit.learning.maps.ray_directions import RAY_COUNT
from kit.learning.tasks.actions import Commands, DiscreteActions, TwistTable
from kit.learning.tasks.learning_task import (
    AvoidGoal,
    CoverGoal,
    FollowGoal,
    LearningTask,
    PatrolGoal,
    TargetGoal,
    TaskCase,
    WallGoal,
)
from kit.learning.tasks.observations import MAX_COORDINATE, MAX_TARGET_DISTANCE
from kit.learning.tasks.rewards import FORWARD_SHARE, Reward, RewardFunction
from kit.learning.tasks.transition import (
    FAR,
    Array,
    Transition,
    average_speeds,
    bearing_of_target,
    distance_to_target,
)
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
    """A reward function gave something else than one finite number for each world."""


class BatchEnv:
    """``n`` worlds of a task. World i depends on (task, seed, first + i) and its own actions alone: it is the same
    to the bit alone or among many.

    Cases are dealt in turn: episode k of world i runs case number ``first + i + k``, counted round and round, so that
    every case gets equally many episodes; or, if ``fixed_cases``, number ``first + i``, so that they get equally many steps.
    ``reward``: instead of the task's own. ``autoreset``: whether a world whose episode has ended begins its next one
    in the same step; else it waits for ``reset``.
    Raises UnsupportedWorld for a map that it cannot represent.
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
        self._goal = GoalCount(task, self._case_arrays)
        self._is_disturbed = bool(task.disturbances)
        self._is_told_later = isinstance(task.goal, WallGoal)
        """Whether what is seen is counted, and told in the next step; else what is counted is seen at once."""
        self._has_obstacles = self._case_arrays.motions.most > 0
        self._has_leaders = bool((self._case_arrays.leaders >= 0).any())
        self._wants_heading = self._goal.wants_heading
        self._has_ways = self._goal.has_targets and not self._has_leaders
        self._far, self._no_heading = np.full((n, task.robots), FAR), np.zeros(n)
        self._parts, self._frames = task.observation.part_slices(), task.observation.frames
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
        self._state = BatchState.allocate(task, n, self._goal.covered_shape)
        self._state.episode -= 1  # the first reset leads to number 0

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
        return self._goal.has_targets or self._has_leaders

    def obstacle_poses(self, world: int) -> FloatArray:
        """(k, 3) where the obstacles of a world are now."""
        which = np.array([world])
        found: FloatArray = self._bodies(which, self._state.step[which])[0]
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
        of the cases that these episodes run, instead of those dealt in turn.
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
        """Puts the worlds ``which`` at the start of their present episodes."""
        state, case_arrays = self._state, self._case_arrays
        turns = (self._first_world + which + state.episode[which]) % len(self.cases)
        dealt = turns if self._assigned is None else self._assigned[which]
        case = dealt if cases is None else np.asarray(cases, dtype=np.int64)[which]
        start = case_arrays.draw_starts(
            case, self._random_keys[which], (state.episode[which] << EPISODE_BITS) + START_DRAWS
        )
        state.case[which] = case
        self._maps[which] = case_arrays.map_of[case]
        state.target_row[which] = start.rows
        state.phase[which] = start.phases if self.task.random_phase else 0.0
        state.step[which] = 0
        state.target[which] = self._leading_targets(which, start.targets)
        state.pose[which] = start.poses
        state.clearance[which] = 0.0
        state.to_go[which] = self._to_go(start.poses, start.rows, state.target[which])
        state.rotation[which] = 0.0
        state.forward_steps[which] = 0.0
        state.move[which] = NO_MOVE
        state.twist[which] = 0.0
        state.speed[which] = 0.0
        state.in_target[which] = self._is_in_target(start.poses, state.target[which], start.rows)
        state.count[which] = 0.0
        if isinstance(self.task.goal, CoverGoal):
            covered = np.zeros((len(which), *state.covered.shape[1:]), dtype=np.bool_)
            counts = np.zeros(len(which))
            self._goal.cover(case, start.poses, covered, counts)
            state.covered[which], state.count[which] = covered, counts
        first = (state.episode[which] << EPISODE_BITS) + DISTURBANCE_DRAWS
        state.disturbed.begin(which, self._random_keys[which], first)

    # One step

    def step(self, actions: NDArray[np.generic]) -> BatchStep:
        """Every world does one step; ``actions``: (n,), or (n, numbers) where one action is several numbers.

        Raises ValueError for actions that are not in the space, and RewardError.
        """
        if len(actions) != self.n:
            raise ValueError(f"{self.n} worlds need {self.n} actions, not {len(actions)}")
        transition, seen = self._simulate(self._actions.commands(actions, self.task.robots))
        terminated, truncated = self.task.endings(transition)
        over = transition.ended.nonzero()[0]
        fresh = self._begin_next(over) if len(over) and self._autoreset else None
        rewards, terms = self._reward(transition)
        last = seen[over]
        if fresh is not None:
            seen[over] = fresh
        return BatchStep(seen, rewards, terminated, truncated, last, transition, terms)

    def _simulate(self, commands: Commands) -> tuple[Transition, Float32Array]:
        """Moves every world by these commands; what happened, and what agents see then."""
        task, old = self.task, self._state
        step, twists, move = old.step + 1, np.ascontiguousarray(commands.twists), commands.moves
        disturbed, moves = self._drive(twists)
        bodies = self._bodies_at_checks()
        target = self._followed(old.target, bodies[-1])
        noise, dropped = self._scan_disturbances(ALL_WORLDS, disturbed, self.n)
        inputs = StepInputs(
            maps=self._maps,
            moves=moves,
            bodies=bodies,
            target_rows=old.target_row,
            targets=target,
            poses=old.pose,
            clearance=old.clearance,
            rotation=old.rotation,
            keys=self._random_keys,
            scan_numbers=self._scan_numbers(old.episode, step),
            noise_std=noise,
            dropped=dropped,
        )
        made = self._loops.step(inputs)
        pose, hit = made.poses, made.collided
        self._state = new = BatchState(
            episode=old.episode,
            case=old.case,
            target=target,
            step=step,
            pose=pose,
            clearance=made.clearance,
            to_go=self._limited_ways(made.to_go, pose, target),
            rotation=made.rotation,
            forward_steps=old.forward_steps + FORWARD_SHARE.take(move, mode="clip"),
            move=move,
            twist=twists,
            speed=average_speeds(old.pose, pose, task.step_time) if task.observation.speeds else old.speed,
            frames=old.frames,
            in_target=self._facing(made.inside, pose, old.target_row),
            target_row=old.target_row,
            phase=old.phase,
            count=old.count,
            covered=old.covered,
            disturbed=disturbed,
        )
        nearest = self._nearest_obstacles(bodies[-1], pose)
        in_target, to_go = new.in_target, new.to_go  # of this step's target; the next one's may follow
        if self._is_told_later:
            seen = self._complete(made.readings, ALL_WORLDS, is_fresh=False)
            self._count(new, old.pose, hit, nearest, made.ranges)
        else:
            self._count(new, old.pose, hit, nearest, made.ranges)
            seen = self._complete(made.readings, ALL_WORLDS, is_fresh=False)
        transition = Transition(
            case=new.case,
            step=step,
            max_steps=task.max_steps,
            hit=hit,
            in_target=in_target,
            was_in_target=old.in_target,
            move=move,
            previous_move=old.move,
            pose=pose,
            previous_pose=old.pose,
            target=target,
            to_go=to_go,
            previous_to_go=old.to_go,
            full_turns=made.full_turns,
            previous_full_turns=made.previous_full_turns,
            forward_steps=new.forward_steps,
            ranges=made.ranges[:, :, :RAY_COUNT],
            twist=twists,
            target_heading=self._target_headings(old.target_row),
            obstacle_distance=nearest,
            achieved=self._achieved(new),
            previous_achieved=self._achieved(old),
            collision_ends=task.collision_ending != "continues",
        )
        return transition, seen

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
        return disturbed, disturbed.moves(task.collision_checks)

    # Things that move, and the goal

    def _bodies(self, which: IntArray | slice, steps: Array) -> FloatArray:
        """(m, k, 3) where the obstacles of the worlds ``which`` are after so many steps (m)."""
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
        return np.stack([self._bodies(ALL_WORLDS, self._state.step + part) for part in parts])

    def _followed(self, targets: FloatArray, bodies: FloatArray) -> FloatArray:
        """(n, 2) the targets, those that move where they are by now."""
        if not self._has_leaders:
            return targets
        leaders = self._case_arrays.leaders[self._state.case]
        places = bodies[np.arange(len(leaders)), np.maximum(leaders, 0), :2]
        return np.where((leaders >= 0)[:, None], places, targets)

    def _leading_targets(self, which: IntArray, targets: FloatArray) -> FloatArray:
        """(m, 2) the first targets of the worlds ``which``."""
        if not self._has_leaders:
            return targets
        leaders = self._case_arrays.leaders[self._state.case[which]]
        bodies = self._bodies(which, self._state.step[which])
        places = bodies[np.arange(len(leaders)), np.maximum(leaders, 0), :2]
        return np.where((leaders >= 0)[:, None], places, targets)

    def _to_go(self, poses: FloatArray, rows: IntArray, targets: FloatArray) -> FloatArray:
        """(m, robots) the ways to the targets; straight ones to a target that moves, none where there is no target."""
        found = self._loops.measure_ways(rows, poses) if self._has_ways else self._far
        return self._limited_ways(found, poses, targets)

    def _limited_ways(self, found: FloatArray, poses: FloatArray, targets: FloatArray) -> FloatArray:
        """(m, robots) the same, where tables have ``found`` the ways to targets that stand."""
        if self._has_ways:
            return np.maximum(found, self.task.path_end)
        if isinstance(self.task.goal, FollowGoal) or self._goal.has_targets:
            distances: FloatArray = distance_to_target(poses, targets)
            return distances
        return np.zeros(poses.shape[:2])

    def _nearest_obstacles(self, bodies: FloatArray, poses: FloatArray) -> FloatArray:
        """(n, robots) [m], FAR where there is none."""
        if not self._has_obstacles:
            return self._far
        nearest = np.full(poses.shape[:2], FAR)
        maps = self._case_arrays.map_of[self._state.case]
        grids.find_nearest_obstacles(self._case_arrays.obstacles, maps, bodies, poses, nearest)
        return nearest

    def _count(
        self,
        new: BatchState,
        before: FloatArray,
        hit: BoolArray,
        nearest: FloatArray,
        ranges: Float32Array | None,
    ) -> None:
        """Counts in the new state what this step has achieved; a step with a collision achieves nothing."""
        if isinstance(self.task.goal, TargetGoal):
            inside: Array = new.in_target[:, 0] if self.task.robots == 1 else new.in_target.all(axis=1)
            new.count = inside.astype(np.float64)
            return
        sound: Array = ~hit.any(axis=1)
        goal = self._goal
        match self.task.goal:
            case PatrolGoal():
                self._go_on_patrol(new, new.in_target.all(axis=1) & sound)
            case CoverGoal():
                new.count, new.covered = new.count.copy(), new.covered.copy()
                goal.cover(new.case, new.pose, new.covered, new.count)
            case FollowGoal():
                seconds = goal.seconds_near_leader(distance_to_target(new.pose, new.target))
                new.count = new.count + np.where(sound, seconds, 0.0)
            case AvoidGoal():
                new.count = new.count + np.where(sound, goal.seconds_away(nearest), 0.0)
            case WallGoal():
                assert ranges is not None
                forward = average_speeds(before, new.pose, self.task.step_time)[:, :, 0] * self.task.step_time
                metres = goal.metres_along_wall(ranges[:, :, :RAY_COUNT], forward)
                new.count = new.count + np.where(sound, metres, 0.0)

    def _achieved(self, state: BatchState) -> FloatArray:
        """(n,) the share of the goal."""
        if isinstance(self.task.goal, TargetGoal):
            return state.count
        share: FloatArray = state.count / self._goal.needed[state.case]
        return share

    def _target_headings(self, rows: IntArray) -> FloatArray:
        """(n,) of the targets ``rows`` (n); 0 where the goal asks for none."""
        return self._case_arrays.targets[rows, 2] if self._wants_heading else self._no_heading

    def _go_on_patrol(self, new: BatchState, arrived: BoolArray) -> None:
        """Makes the next target of a case the target where all robots have arrived."""
        case_arrays, which = self._case_arrays, np.flatnonzero(arrived)
        new.count = new.count + arrived
        if not len(which):
            return
        cases = new.case[which]
        place = (new.count[which].astype(np.int64)) % case_arrays.target_count[cases]
        rows = case_arrays.target_first[cases] + place
        targets = case_arrays.targets[rows, :2]
        new.target_row, new.target = new.target_row.copy(), new.target.copy()
        new.to_go, new.in_target = new.to_go.copy(), new.in_target.copy()
        new.target_row[which], new.target[which] = rows, targets
        new.to_go[which] = case_arrays.to_go(rows, new.pose[which])
        new.in_target[which] = self._is_in_target(new.pose[which], targets, rows)

    def _begin_next(self, over: IntArray) -> Float32Array:
        """Begins the next episodes of the worlds ``over`` (m); (m, size) what agents see of them."""
        self._state.unshare_arrays()
        self._state.episode[over] += 1
        self._begin_episodes(over)
        return self._observe(over, len(over), is_fresh=True)

    def _is_in_target(self, poses: FloatArray, targets: FloatArray, rows: IntArray) -> BoolArray:
        """(m, robots): who is in the target, of the number ``rows`` (m)."""
        return self._facing(self._loops.find_arrivals(poses, targets), poses, rows)

    def _facing(self, inside: BoolArray, poses: FloatArray, rows: IntArray) -> BoolArray:
        """(m, robots): who of those ``inside`` the target has the heading that the goal asks for."""
        return inside & self._goal.is_facing(poses, rows) if self._wants_heading else inside

    # What agents see and earn

    def _observe(self, which: IntArray | slice, m: int, *, is_fresh: bool) -> Float32Array:
        """(m, size) what agents see of the worlds ``which`` (m) as they are; ``is_fresh``: whether their episodes have just begun."""
        state = self._state
        noise, dropped = self._scan_disturbances(which, state.disturbed, m)
        scan = self._loops.scan(
            self._maps[which],
            state.pose[which],
            self._random_keys[which],
            self._scan_numbers(state.episode[which], state.step[which]),
            noise,
            dropped,
            self._bodies(which, state.step[which]),
        )
        return self._complete(scan.frame, which, is_fresh=is_fresh)

    def _scan_numbers(self, episodes: IntArray, steps: IntArray) -> IntArray:
        """(m,) of the first random numbers of scans after ``steps`` (m) steps of ``episodes`` (m)."""
        return (episodes << EPISODE_BITS) + steps * self.task.robots

    def _scan_disturbances(
        self, which: IntArray | slice, disturbed: DisturbanceState, m: int
    ) -> tuple[FloatArray, FloatArray]:
        """(m,) each: the standard deviation of the ranges [m], and the share of rays that read nothing."""
        if not self._is_disturbed:
            return self._usual_noise[:m], self._no_dropped[:m]
        return disturbed.noise_std(self._case_arrays.fleet.noise_std, which), disturbed.dropped(which)

    def _complete(self, frame: Float32Array, which: IntArray | slice, *, is_fresh: bool) -> Float32Array:
        """(m, size) what agents see of the worlds ``which``: ``frame`` (m, robots, size), with what is not of their rays."""
        for name, place in self._parts.items():
            frame[:, :, place] = self._part(name, which)
        flat = frame.reshape(len(frame), -1)
        return flat if self._frames == 1 else self._stacked(flat, which, is_fresh=is_fresh)

    def _part(self, name: str, which: IntArray | slice) -> Array:
        """(m, robots, size) the numbers of one part of the observation."""
        state, scale = self._state, self.task.observation.scale
        pose, target = state.pose[which], state.target[which]
        match name:
            case "target":
                distance = np.minimum(distance_to_target(pose, target), MAX_TARGET_DISTANCE) * scale
                return np.stack([distance, bearing_of_target(pose, target) / np.pi], axis=2)
            case "target_heading":
                off = self._case_arrays.targets[state.target_row[which], 2][:, None] - pose[:, :, 2]
                return np.stack([np.cos(off), np.sin(off)], axis=2)
            case "achieved":
                share = np.minimum(state.count[which] / self._goal.needed[state.case[which]], 1.0)
                return np.repeat(share[:, None, None], self.task.robots, axis=1)
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

    def _stacked(self, frame: Float32Array, which: IntArray | slice, *, is_fresh: bool) -> Float32Array:
        """(m, frames * size) the last frames, the newest last; of a fresh episode all are its first one."""
        state, count = self._state, self.task.observation.frames
        past = np.repeat(frame[:, None], count - 1, axis=1) if is_fresh else state.frames[which]
        stack = np.concatenate([past, frame[:, None]], axis=1)
        kept = state.frames.copy()
        kept[which] = stack[:, 1:]
        state.frames = kept
        return stack.reshape(len(frame), -1)

    def _reward(self, transition: Transition) -> tuple[Float32Array, dict[str, Array]]:
        """(n,) rewards, and what each term adds; of code from outside its metrics."""
        if isinstance(self._reward_function, Reward):
            terms = self._reward_function.terms(transition)
            return np.asarray(sum(terms.values()), dtype=np.float32), terms
        rewards = self._checked(np.asarray(self._reward_function(transition)), "reward")
        count_metrics = getattr(self._reward_function, "metrics", None)  # of a student's file
        metrics = {} if count_metrics is None else count_metrics(transition)
        return rewards, {name: self._checked(values, f"metric {name}") for name, values in metrics.items()}

    def _checked(self, values: Array, name: str) -> Float32Array:
        """(n,) what code from outside gave, in single precision. RewardError unless it is a finite number for each world."""
        if values.shape != (self.n,) or values.dtype.kind not in "fiub":
            raise RewardError(
                f"the {name} must be {self.n} numbers, one for each world: this is an array of shape "
                f"{values.shape} and type {values.dtype}"
            )
        numbers: Float32Array = values.astype(np.float32)
        if not np.isfinite(numbers).all():
            raise RewardError(
                f"the {name} is {numbers[~np.isfinite(numbers)][0]}: it must be a finite number"
            )
        return numbers
