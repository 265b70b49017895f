"""The batch engine: each world by itself, starts, endings, observations, rewards from outside."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from kit.learning.environment.batch import BatchEnv, RewardError
from kit.learning.environment.batch_state import BatchStep
from kit.learning.environment.env import TaskEnv
from kit.learning.tasks.actions import Move
from kit.learning.tasks.catalogue import HALLWAY, TASKS, TURN, WHEELCHAIRS
from kit.learning.tasks.learning_task import LearningTask, StartVariation
from kit.learning.tasks.observations import MAX_TARGET_DISTANCE
from kit.learning.tasks.reward import RewardFunction
from kit.learning.tasks.rewards import ALGORITHM_1
from kit.learning.tasks.transition import Array, Transition, bearing_of_target, distance_to_target
from tests.learning.worlds import (
    FOUR_MOVES,
    NINETEEN_NUMBERS,
    SEVEN_MOVES,
    SEVENTEEN_NUMBERS,
    actions_of,
    short,
    steps,
)

STRAIGHT = short(HALLWAY, "straight")
every_task = pytest.mark.parametrize("task", TASKS, ids=lambda task: task.name)


def bits(step: BatchStep, world: int) -> tuple[bytes, ...]:
    """All that a step tells of one world."""
    arrays = (step.observations, step.rewards, step.terminated, step.truncated, step.final_observations())
    transition = step.transition.select(world)
    return (
        *(array[world].tobytes() for array in arrays),
        *(value[world].tobytes() for value in step.terms.values()),
        *(np.asarray(getattr(transition, name)).tobytes() for name in ("pose", "ranges", "to_go", "abreast")),
    )


# Each world by itself


@pytest.mark.long_cases(
    "hallway",
    "hallway-seed",
    "hallway-seed-as-run",
    "wheelchairs",
    "wheelchairs-seed",
    "wheelchairs-seed-as-run",
    "wheelchairs-seed-49",
    "wheelchairs-seed-49-as-run",
    "wheelchairs-seed-49-wide",
    "wheelchairs-seed-49-wide-as-run",
)
@every_task
def test_a_world_is_the_same_to_the_bit_alone_or_among_many(task: LearningTask) -> None:
    n, chance = 5, np.random.default_rng(4)
    together = BatchEnv(task, n, seed=7, first=3)
    alone = [BatchEnv(task, 1, seed=7, first=3 + i) for i in range(n)]
    seen = together.reset()
    assert [each.reset()[0].tobytes() for each in alone] == [row.tobytes() for row in seen]
    for _ in range(60):
        actions = actions_of(together, chance)
        step = together.step(actions)
        for i, each in enumerate(alone):
            assert bits(each.step(actions[i : i + 1]), 0) == bits(step, i)


@pytest.mark.long_cases(
    "hallway",
    "hallway-seed",
    "hallway-seed-as-run",
    "wheelchairs",
    "wheelchairs-seed",
    "wheelchairs-seed-as-run",
    "wheelchairs-seed-49",
    "wheelchairs-seed-49-as-run",
    "wheelchairs-seed-49-wide",
    "wheelchairs-seed-49-wide-as-run",
)
@every_task
def test_a_seed_repeats_everything(task: LearningTask) -> None:
    batch, again, other = (BatchEnv(task, 4, seed) for seed in (1, 1, 2))
    runs = []
    for each in (batch, again, other):
        first = each.reset().tobytes()
        runs.append((first, [step.observations.tobytes() for step in steps(each, 30)]))
    assert runs[0] == runs[1]
    assert runs[0][0] != runs[2][0]
    assert batch.reset(1).tobytes() == runs[0][0]
    assert batch.reset(2).tobytes() == runs[2][0]


@every_task
def test_observations_stay_in_their_space(task: LearningTask) -> None:
    batch = BatchEnv(task, 30, seed=3)
    assert all(batch.observation_space.contains(row) for row in batch.reset())
    for step in steps(batch, 60):
        assert all(batch.observation_space.contains(row) for row in step.final_observations())
        assert all(batch.action_space.contains(batch.action_space.sample()) for _ in range(2))


def test_what_a_step_gave_is_not_changed_by_the_next() -> None:
    batch = BatchEnv(HALLWAY, 20, seed=1)
    batch.reset()
    kept = next(steps(batch, 1))
    before = [bits(kept, i) for i in range(20)]
    list(steps(batch, 40))
    assert [bits(kept, i) for i in range(20)] == before


def test_a_transition_goes_on_where_the_last_one_ended() -> None:
    batch = BatchEnv(HALLWAY, 20, seed=1)
    batch.reset()
    last = None
    for step in steps(batch, 30):
        if last is not None:
            going = ~last.ended
            for now, then in (
                (step.transition.previous_pose, last.transition.pose),
                (step.transition.previous_to_go, last.transition.to_go),
                (step.transition.previous_move, last.transition.move),
                (step.transition.was_in_target, last.transition.in_target),
            ):
                assert np.array_equal(now[going], then[going])
            assert (step.transition.previous_move[last.ended] == -1).all()
            assert (step.transition.step[last.ended] == 1).all()
        last = step


# Beginnings


def test_cases_are_dealt_in_turn() -> None:
    batch = BatchEnv(HALLWAY, 17, seed=0, first=2)
    batch.reset()
    assert batch.state.case.tolist() == [(2 + i) % 15 for i in range(17)]
    batch.reset()
    assert batch.state.case.tolist() == [(3 + i) % 15 for i in range(17)]
    batch.reset(cases=np.arange(17) % 4)
    assert batch.state.case.tolist() == [i % 4 for i in range(17)]


def test_a_world_may_stay_with_its_case() -> None:
    batch = BatchEnv(HALLWAY, 17, seed=0, first=2, fixed_cases=True)
    batch.reset()
    for _ in range(300):
        batch.step(np.ones(17, dtype=np.int64))
    assert batch.state.episode.min() > 0
    assert batch.state.case.tolist() == [(2 + i) % 15 for i in range(17)]


def test_worlds_that_stay_are_dealt_anew_when_their_episodes_are_over() -> None:
    task = replace(HALLWAY.on("straight", "left_door", "turn_left_90"), max_steps=5)
    batch = BatchEnv(task, 20, seed=0, fixed_cases=True)
    batch.reset()
    batch.assign_cases(np.array([0.1, 0.65, 0.25]))
    assert np.bincount(batch.state.case).tolist() == [7, 7, 6]
    for _ in range(6):
        batch.step(np.zeros(20, dtype=np.int64))
    assert np.bincount(batch.state.case).tolist() == [2, 13, 5]
    kept = batch.state.case == np.arange(20) % 3
    assert kept.sum() == 2 + 7 + 5
    with pytest.raises(ValueError, match="in turn"):
        BatchEnv(task, 20, seed=0).assign_cases(np.array([0.1, 0.65, 0.25]))


def test_a_world_whose_episode_ended_goes_on_with_the_next_case() -> None:
    batch = BatchEnv(TURN, 6, seed=0)
    batch.reset()
    before = batch.state.case.copy()
    ended = np.zeros(6, dtype=np.int64)
    for step in steps(batch, 120):
        ended += step.ended
    assert ended.max() > 1
    assert batch.state.case.tolist() == ((before + ended) % 2).tolist()


@every_task
def test_no_start_touches_anything_or_is_in_the_target(task: LearningTask) -> None:
    cases = len(task.map_cases())
    n = cases * -(-2000 // cases)
    task = replace(task, actions=replace(task.actions, twist_table=((0.0, 0.0),) * len(task.actions.names)))
    batch = BatchEnv(task, n, seed=11)
    batch.reset()
    assert not batch.state.in_target.any()
    step = next(steps(batch, 1))
    assert not step.transition.hit.any()


def test_starts_are_spread_as_the_case_says() -> None:
    batch = BatchEnv(STRAIGHT, 4000, seed=2)
    batch.reset()
    pose, target, (case,) = batch.state.pose[:, 0], batch.state.target, batch.cases
    across = pose[:, 0] - case.start.x
    assert np.abs(across).max() <= 0.3
    assert np.histogram(across, 6, (-0.3, 0.3))[0] == pytest.approx(np.full(6, 4000 / 6), rel=0.15)
    assert np.ptp(pose[:, 2]) == pytest.approx(2 * math.pi, rel=0.01)
    assert (pose[:, 1] == case.start.y).all()
    assert (target[:, 1] == case.target[1]).all()
    assert np.corrcoef(across, target[:, 0])[0, 1] == pytest.approx(0.0, abs=0.05)


def test_an_exact_start_is_exact() -> None:
    batch = BatchEnv(replace(HALLWAY, start=StartVariation(shifted=False)), 15, seed=2)
    batch.reset()
    assert [tuple(pose) for pose in batch.state.pose[:, 0]] == [tuple(case.start) for case in batch.cases]
    assert [tuple(target) for target in batch.state.target] == [case.target for case in batch.cases]


@pytest.mark.parametrize("gap", [None, 0.4, 0.5])
def test_two_robots_start_as_far_apart_as_the_task_wants(gap: float | None) -> None:
    batch = BatchEnv(replace(WHEELCHAIRS, start=StartVariation(gap=gap)), 9, seed=2)
    batch.reset()
    left, right = batch.state.pose[:, 0], batch.state.pose[:, 1]
    assert np.hypot(*(left - right)[:, :2].T) == pytest.approx(0.3 if gap is None else gap)
    rightwards = np.stack([np.sin(left[:, 2]), -np.cos(left[:, 2])], axis=1)
    assert ((right - left)[:, :2] * rightwards).sum(axis=1).min() > 0


# Endings


def stopping(task: LearningTask, **changes: object) -> tuple[BatchEnv, BatchStep]:
    """The last step of an episode in which the robot only stops."""
    batch = BatchEnv(replace(task, max_steps=30, **changes), 3, seed=0)
    batch.reset()
    for _ in range(29):
        assert not batch.step(np.zeros(3, dtype=np.int64)).ended.any()
    return batch, batch.step(np.zeros(3, dtype=np.int64))


def test_running_out_of_time_truncates() -> None:
    _, step = stopping(STRAIGHT)
    assert step.truncated.all()
    assert not step.terminated.any()
    assert step.transition.timed_out.all()


def test_running_out_of_time_terminates_where_the_task_says_so() -> None:
    _, step = stopping(STRAIGHT, timeout_terminal=True)
    assert step.terminated.all()
    assert not step.truncated.any()


def test_the_last_observation_is_of_the_episode_that_ended() -> None:
    batch, step = stopping(replace(STRAIGHT, lidar_noise=0.0))
    assert not np.array_equal(step.final_observations(), step.observations)
    assert (batch.state.step == 0).all()
    assert (step.transition.step == 30).all()
    front = step.transition.front[:, 0]
    assert step.final_observations()[:, 0] == pytest.approx(0.5 * front)


def test_without_restart_a_world_waits() -> None:
    batch = BatchEnv(replace(STRAIGHT, max_steps=3), 2, seed=0, autoreset=False)
    batch.reset()
    for _ in range(3):
        step = batch.step(np.zeros(2, dtype=np.int64))
    assert step.truncated.all()
    assert (batch.state.step == 3).all()
    assert np.array_equal(step.observations, step.final_observations())
    batch.reset()
    assert (batch.state.episode == 1).all()


def test_straight_into_the_wall_is_a_collision() -> None:
    batch = BatchEnv(replace(STRAIGHT, start=StartVariation(shifted=False)), 1, seed=0)
    batch.reset()
    back = SEVEN_MOVES.moves.index(Move.BACK)
    for _ in range(20):
        step = batch.step(np.array([back]))
        if step.ended[0]:
            break
    assert step.transition.collided[0]
    assert step.terminated[0]
    assert step.transition.hit[0, 0]
    tail = step.transition.pose[0, 0, 1] - 0.117
    assert 0.1 <= tail <= 0.1 + 0.03  # half a step's way


def test_two_robots_that_run_into_each_other() -> None:
    task = replace(short(WHEELCHAIRS, "pair_straight"), start=StartVariation(gap=0.4))
    batch = BatchEnv(task, 1, seed=0)
    batch.reset()
    inwards = FOUR_MOVES.moves.index(Move.RIGHT), FOUR_MOVES.moves.index(Move.LEFT)
    ahead = FOUR_MOVES.moves.index(Move.FORWARD)
    for _ in range(7):
        batch.step(np.array([inwards]))
    for _ in range(20):
        step = batch.step(np.array([[ahead, ahead]]))
        if step.ended[0]:
            break
    assert step.transition.hit.tolist() == [[True, True]]


@pytest.mark.parametrize(("measured", "way"), [("hull", 0.25 + 0.048), ("axle", 0.25)])
def test_the_target_is_measured_to_the_hull_or_to_the_axle(measured: str, way: float) -> None:
    task = replace(STRAIGHT, start=StartVariation(shifted=False), measured_to=measured)
    batch = BatchEnv(task, 1, seed=0)
    batch.reset()
    ahead = np.array([SEVEN_MOVES.moves.index(Move.FORWARD)])
    for _ in range(60):
        step = batch.step(ahead)
        if step.ended[0]:
            break
    assert step.transition.reached[0]
    assert way - 0.061 < step.transition.distance[0, 0] <= way


def test_both_robots_must_be_in_the_target_at_once() -> None:
    batch = BatchEnv(replace(WHEELCHAIRS, target_radius=0.9), 60, seed=1)
    batch.reset()
    one_only = 0
    for step in steps(batch, 80):
        inside = step.transition.in_target
        assert (step.transition.reached == inside.all(axis=1) & ~step.transition.collided).all()
        one_only += int((inside.any(axis=1) & ~inside.all(axis=1) & ~step.ended).sum())
    assert one_only


@pytest.mark.long
@pytest.mark.parametrize("task", [HALLWAY, WHEELCHAIRS], ids=lambda task: task.name)
def test_to_spare_the_search_for_walls_changes_nothing(task: LearningTask) -> None:
    batch, searching = (BatchEnv(task, 40, seed=6) for _ in range(2))
    batch.reset()
    searching.reset()
    chance = np.random.default_rng(6)
    for _ in range(60):
        actions = actions_of(batch, chance)
        searching.state.robots.clearance[:] = 0.0
        step, other = batch.step(actions), searching.step(actions)
        assert [bits(step, i) for i in range(40)] == [bits(other, i) for i in range(40)]


# What is seen


def test_noise_is_new_at_every_step_and_as_strong_as_it_should_be() -> None:
    batch = BatchEnv(replace(STRAIGHT, max_steps=10**6), 5, seed=0)
    batch.reset()
    still = np.zeros(5, dtype=np.int64)
    scans = np.stack([batch.step(still).transition.ranges for _ in range(400)])
    near = scans.max(axis=0) < 1.9  # not cut off
    assert near.sum() > 200
    assert scans.std(axis=0)[near].mean() == pytest.approx(0.015, rel=0.05)
    drawn = (scans - scans.mean(axis=0))[:, near]
    assert abs(np.corrcoef(drawn[1:].ravel(), drawn[:-1].ravel())[0, 1]) < 0.01
    assert abs(np.corrcoef(drawn[:, 1:].ravel(), drawn[:, :-1].ravel())[0, 1]) < 0.01


def test_seventeen_numbers() -> None:
    batch = BatchEnv(replace(HALLWAY, lidar_noise=0.0), 15, seed=3)
    batch.reset()
    step = batch.step(np.zeros(15, dtype=np.int64))
    ranges, seen = step.transition.ranges[:, 0], step.final_observations() / 0.5
    assert seen[:, :5] == pytest.approx(ranges[:, [45, 47, 43, 68, 22]])
    behind = np.concatenate([ranges[:, :8], ranges[:, 83:]], axis=1)
    assert seen[:, 5] == pytest.approx(behind.min(axis=1))
    assert seen[:, 6] == pytest.approx(ranges[:, 8:23].min(axis=1))
    for sector in range(9):
        first = 23 + 5 * sector
        assert seen[:, 7 + sector] == pytest.approx(ranges[:, first : first + 5].min(axis=1))
    assert seen[:, 16] == pytest.approx(ranges[:, 68:83].min(axis=1))


def test_target_and_arrival_can_be_seen() -> None:
    seen = replace(SEVENTEEN_NUMBERS, target=True, arrived=True)
    batch = BatchEnv(replace(HALLWAY, observation=seen, target_radius=0.9), 15, seed=3)
    batch.reset()
    for step in steps(batch, 30):
        last = step.final_observations()[:, -3:]
        transition = step.transition
        away = np.minimum(distance_to_target(transition.pose, transition.target)[:, 0], MAX_TARGET_DISTANCE)
        assert last[:, 0] == pytest.approx(0.5 * away)
        assert last[:, 1] == pytest.approx(
            bearing_of_target(transition.pose, transition.target)[:, 0] / math.pi
        )
        assert (last[:, 2] == transition.in_target[:, 0]).all()


def test_two_robots_see_each_other_beside_them() -> None:
    task = replace(short(WHEELCHAIRS, "pair_straight"), start=StartVariation(gap=0.4), lidar_noise=0.0)
    batch = BatchEnv(task, 1, seed=0)
    seen = batch.reset()[0].reshape(2, NINETEEN_NUMBERS.size) / WHEELCHAIRS.observation.scale
    hull = [(0.4 - 0.055) / math.cos(math.radians(degrees)) for degrees in (6, 10)]  # wheels are not seen
    assert seen[:, 5:7] == pytest.approx(np.array([hull] * 2), abs=1e-3)
    step = batch.step(np.zeros((1, 2), dtype=np.int64))
    assert step.transition.adjacent[0]
    assert step.transition.abreast[0] == pytest.approx(1.0)


def test_whole_turns_are_counted_until_the_other_way() -> None:
    batch = BatchEnv(STRAIGHT, 1, seed=0)
    batch.reset()
    left, right = (np.array([SEVEN_MOVES.moves.index(move)]) for move in (Move.LEFT, Move.RIGHT))
    counts = [int(batch.step(left).transition.full_turns[0, 0]) for _ in range(62)]
    assert [counts.index(1) + 1, counts.index(2) + 1] == [30, 60]
    assert batch.step(right).transition.full_turns[0, 0] == 0


# Wrong input


@pytest.mark.parametrize("actions", [[0, 7, 0], [0, -1, 0], [0, 0]])
def test_actions_outside_the_space_are_refused(actions: list[int]) -> None:
    batch = BatchEnv(HALLWAY, 3, seed=0)
    batch.reset()
    with pytest.raises(ValueError, match="action"):
        batch.step(np.array(actions))


def test_a_reward_of_ones_own_is_called_once_for_all_worlds() -> None:
    calls = []

    def mine(t: Transition) -> Array:
        calls.append(t.step.shape)
        return np.where(t.collided, -1.0, t.front[:, 0])

    batch = BatchEnv(HALLWAY, 40, seed=0, reward=mine)
    batch.reset()
    for step in steps(batch, 10):
        assert step.rewards == pytest.approx(
            np.where(step.transition.collided, -1.0, step.transition.front[:, 0])
        )
        assert step.terms == {}
    assert calls == [(40,)] * 10


@pytest.mark.parametrize(
    "wrong",
    [
        lambda t: np.full(len(t.step), np.nan),
        lambda t: 1.0,
        lambda t: np.zeros((len(t.step), 1)),
        lambda t: ["good"] * len(t.step),
        lambda t: None,
    ],
)
def test_a_reward_that_is_no_number_for_each_world(wrong: Callable[[Transition], Array]) -> None:
    reward: RewardFunction = wrong
    batch = BatchEnv(HALLWAY, 3, seed=0, reward=reward)
    batch.reset()
    with pytest.raises(RewardError, match=r"number|nothing"):
        batch.step(np.zeros(3, dtype=np.int64))


def test_another_reward_record_tells_its_terms() -> None:
    batch = BatchEnv(TURN, 2, seed=0, reward=ALGORITHM_1)
    batch.reset()
    assert list(next(steps(batch, 1)).terms) == [weight.term for weight in ALGORITHM_1.weights]


def test_at_least_one_world_and_a_reward_that_can_be_called() -> None:
    for count in (0, -1):
        with pytest.raises(ValueError, match=f"not {count}"):
            BatchEnv(TURN, count)
    for make in (lambda: BatchEnv(TURN, 1, reward="mine.py"), lambda: TaskEnv(TURN, reward="mine.py")):  # type: ignore[arg-type]
        with pytest.raises(TypeError, match=r"mine\.py"):
            make()


def test_a_notebook_shows_a_task_and_its_worlds_in_a_line() -> None:
    for shown in (TURN, BatchEnv(TURN, 2), TURN.map_cases()[0][0]):
        assert "turn" in repr(shown)
        assert len(repr(shown)) < 80
