"""Rewards judged by what they ask for: nine of the literature, the dissertation's, and contracts that are broken."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from grader.assignment import Assignment, GridTask
from grader.kinds.reward.behaviours import discounted_return
from grader.kinds.reward.evidence import RewardEvidence
from grader.kinds.reward.mirrored_cases import mirrored, rotated
from grader.kinds.reward.optimal_policy import evaluate_policy, rollout, value_iteration
from grader.kinds.reward.reward_training import RewardTrainingParams
from grader.kinds.reward.task_model import (
    FORWARD,
    HEADINGS,
    LAST_MOVES,
    LEFT,
    NO_MOVE,
    GridModel,
    build_model,
)
from grader.kinds.reward.transitions import MODEL_FACTS, TransitionBatch, to_transition
from kit.arrays import FloatArray
from kit.host.failure import FailureKind
from kit.host.sandbox.limits import GRADER_LIMITS
from kit.host.sandbox.sandbox_config import Level
from kit.learning.tasks.reward import Reward, RewardFunction
from kit.learning.tasks.rewards import ALGORITHM_1, ALGORITHM_3
from kit.learning.tasks.student_reward import LARGEST_REWARD, reward_columns

ROOM = GridTask(
    (
        "###############",
        *("#.............#",) * 3,
        "#..........G..#",
        *("#.............#",) * 2,
        "#....######...#",
        *("#.............#",) * 6,
        "###############",
    ),
    discount=0.98,
    max_steps=200,
)
SMALL = GridTask(("########", "#......#", "#.##...#", "#....G.#", "########"), discount=0.98, max_steps=80)

HALLS = (
    ("#######", *("#.....#",) * 2, "#..G..#", *("#.....#",) * 7, "#######"),
    ("############", *("#..........#",) * 2, "#........G.#", *("#....#######",) * 5, "############"),
    ROOM.rows,
)
"""A hallway, its corner, and a room so wide that looking at much of it could pay better than arriving; it does not,
for no agent sees farther than two metres."""

REWARDS = {
    "sparse": ("reached, collided", "return 10.0 * reached - 10.0 * collided - 0.1"),
    "shaped": (
        "reached, collided, distance, previous_distance",
        "return 10.0 * reached - 10.0 * collided - 0.1 + previous_distance - 0.98 * distance * (not (reached or collided))",
    ),
    "progress": (
        "reached, collided, to_go, previous_to_go",
        "return 10.0 * reached - 10.0 * collided + previous_to_go - to_go - 0.01",
    ),
    "one-sided": (
        "reached, distance, previous_distance, collided",
        "return max(0.0, previous_distance - distance) * 10 + 1.0 * reached - collided",
    ),
    "closeness": ("distance, collided", "return 1.0 / (1.0 + distance) - collided"),
    "alive": ("reached, collided", "return 0.0 if collided else 10.0 if reached else 1.0"),
    "moving": (
        "move, reached, collided",
        "return (0.5 if move in (1, 2) else 0.0) + 5.0 * reached - 5.0 * collided",
    ),
    "turning": (
        "move, reached, collided",
        "return (0.5 if move in (3, 4) else 0.0) + 5.0 * reached - 5.0 * collided",
    ),
    "sign": ("distance, previous_distance, collided", "return distance - previous_distance - collided"),
}
GOOD = ("sparse", "shaped", "progress")


def source(name: str) -> str:
    names, body = REWARDS[name]
    return f"def reward({names}):\n{textwrap.indent(body, '    ')}\n"


@cache
def room(task: GridTask = ROOM) -> GridModel:
    return build_model(task)


def examine(folder: Path, text: str, task: GridTask = SMALL) -> RewardEvidence:
    file = folder / "reward.py"
    file.write_text(textwrap.dedent(text))
    assignment = Assignment(
        folder, "r", "R", "reward", "reward.py", Level.LIMITED, GRADER_LIMITS, (), (), task, "v", False
    )
    return RewardEvidence(file, assignment, Level.LIMITED)


@pytest.fixture(scope="module")
def examined(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], RewardEvidence]:
    """Each of the nine in the wide room, examined once."""
    return cache(lambda name: examine(tmp_path_factory.mktemp("nine"), source(name), ROOM))


@pytest.mark.long_cases("alive", "closeness", "moving", "one-sided", "turning")
@pytest.mark.parametrize("name", REWARDS)
def test_nine_rewards_are_judged_by_what_they_ask_for(
    examined: Callable[[str], RewardEvidence], name: str
) -> None:
    exam = examined(name)
    assert exam.failure is None
    if name in GOOD:
        assert exam.plan_outcome.success == pytest.approx(1.0)
        assert exam.plan_outcome.exploit_start is None
        assert exam.picture() == ""
        assert exam.plan_outcome.steps < 20
    else:
        assert exam.plan_outcome.success < 0.5
        shown = exam.picture()
        assert "S start" in shown
        assert "G target" in shown


@pytest.mark.long_cases("alive", "closeness", "moving", "one-sided", "turning")
@pytest.mark.parametrize("name", sorted(set(REWARDS) - set(GOOD)))
def test_the_exploit_is_a_way_that_never_arrives(
    examined: Callable[[str], RewardEvidence], name: str
) -> None:
    exam = examined(name)
    assert exam.plan_outcome.exploit_start is not None
    way = rollout(exam.policy, exam.plan_outcome.exploit_start, ROOM.max_steps)
    assert len(way) == ROOM.max_steps + 1
    assert exam.model.target not in exam.model.cell_of(way)
    # Replayed move by move, no other way pays as well: it is what the reward asks for.
    moves = (way[1:] % LAST_MOVES).tolist()
    own = discounted_return(exam.model, exam.rewards, int(way[0]), moves)
    best = float(exam.policy.values[way[0]].max())
    assert own == pytest.approx(best, abs=2 * ROOM.discount**ROOM.max_steps * abs(best) + 1e-6)


def rewards_of(reward: RewardFunction, model: GridModel) -> FloatArray:
    """(states, moves) rewards of one of the kit's functions, as if every transition began an episode."""
    return np.asarray(reward(to_transition(TransitionBatch.all(model)))).reshape(model.states, -1)


def state_at(model: GridModel, column: int, row: int, heading: int) -> int:
    """The start state in a cell."""
    (cell,) = np.flatnonzero((model.cells == (column, row)).all(axis=1))
    return (int(cell) * HEADINGS + heading) * LAST_MOVES + NO_MOVE


@pytest.mark.parametrize("rows", HALLS, ids=["hall", "turn", "room"])
@pytest.mark.parametrize("reward", [ALGORITHM_1, ALGORITHM_3], ids=lambda each: each.name)
def test_the_seeds_own_algorithms_teach_what_they_should(reward: Reward, rows: tuple[str, ...]) -> None:
    model = build_model(GridTask(rows, 0.98, 200))
    outcome = evaluate_policy(value_iteration(model, rewards_of(reward, model)))
    assert outcome.success == pytest.approx(1.0)


def test_a_reward_that_says_nothing_does_not_pass() -> None:
    """Every move is as good as every other one; some luck does not make it a reward."""
    model = room()
    outcome = evaluate_policy(value_iteration(model, np.zeros((model.states, 4))))
    assert outcome.success < 0.5


def test_values_satisfy_bellmans_equation() -> None:
    model = room(SMALL)
    rewards = np.random.default_rng(3).normal(size=(model.states, 4))
    made = value_iteration(model, rewards)
    ahead = made.values.max(axis=1)[model.next] * ~model.done
    assert made.values == pytest.approx(rewards + SMALL.discount * ahead, abs=1e-7)


def test_the_model_drives_as_the_map_says() -> None:
    model = room(SMALL)
    east = state_at(model, 1, 3, 0)
    assert model.cells[model.cell_of(model.next[east, FORWARD])].tolist() == [2, 3]
    assert model.heading_of(model.next[east, LEFT]) == 1
    assert model.next[east, LEFT] % LAST_MOVES == LEFT
    # Between two walls that touch at a corner nothing passes.
    assert model.hit[state_at(model, 1, 3, HEADINGS - 1), FORWARD]
    beside = state_at(model, 4, 1, 0)
    assert model.reached[beside, FORWARD]
    assert not model.hit[beside, FORWARD]
    assert (model.starts % LAST_MOVES == NO_MOVE).all()


def test_every_fact_that_the_model_knows_is_told() -> None:
    steps = TransitionBatch.all(room(SMALL))
    for name, column in reward_columns(to_transition(steps), MODEL_FACTS).items():
        assert len(column) == len(steps), name


@pytest.mark.parametrize("turned", [mirrored, rotated])
def test_a_turned_task_is_the_same_task(turned: Callable[[TransitionBatch], TransitionBatch]) -> None:
    steps = TransitionBatch.all(room(SMALL))
    other = turned(steps)
    assert np.array_equal(other.hit, steps.hit)
    assert np.array_equal(other.reached, steps.reached)
    for name in ("distance", "to_go", "front"):
        assert np.allclose(getattr(to_transition(other), name), getattr(to_transition(steps), name)), name


@pytest.mark.parametrize(
    ("body", "least", "most"), [("-abs(bearing)", 0.999, 1), ("bearing", 0, 0.6), ("pose[0]", 0, 0.2)]
)
def test_symmetry(tmp_path: Path, body: str, least: float, most: float) -> None:
    exam = examine(tmp_path, f"def reward(bearing, pose): return {body}")
    assert least <= exam.symmetry <= most


@pytest.mark.parametrize(
    ("text", "pure"),
    [
        ("def reward(distance): return -distance", True),
        ("import random\ndef reward(distance): return random.random()", False),
        ("n = 0\ndef reward(distance):\n    global n\n    n += 1\n    return -distance - 1e-9 * n", False),
        (
            "last = [0.0]\ndef reward(distance):\n    d = distance - last[0]\n    last[0] = distance\n    return d",
            False,
        ),
        ("import time\ndef reward(distance): return time.time()", False),
        ("def reward(distance, seen=None): return 0.0", None),
    ],
)
def test_a_reward_has_no_memory_and_no_chance(tmp_path: Path, text: str, pure: bool | None) -> None:
    exam = examine(tmp_path, text)
    if pure is None:
        assert exam.failure is not None
    else:
        assert exam.is_pure is pure


@pytest.mark.parametrize(
    ("text", "kind", "said"),
    [
        ("def reword(distance): return 1", FailureKind.IMPORT, "no function reward"),
        ("def reward(*distance): return 1", FailureKind.IMPORT, "leave out"),
        ("def reward(distanse): return 1", FailureKind.IMPORT, 'did you mean "distance"'),
        ("def reward(distance: return 1", FailureKind.IMPORT, "not Python"),
        ("(" * 5000, FailureKind.IMPORT, "not Python"),
        ("-" * 100_000 + "1", FailureKind.IMPORT, "not Python"),
        ("def reward(distance): return float('nan')", FailureKind.EXCEPTION, "finite"),
        ("def reward(distance): return 1e999", FailureKind.EXCEPTION, "finite"),
        ("def reward(distance): return True", FailureKind.EXCEPTION, "finite"),
        ("def reward(step): return 1", FailureKind.IMPORT, "does not have"),
        ("def reward(distance): return 2e9", FailureKind.EXCEPTION, "1e+09"),
        ("def reward(distance): return -10**300", FailureKind.EXCEPTION, "-1e+300"),
        (
            "def reward(to_go): return 1.7e308 if int(to_go * 1000) % 2 else -1.7e308",
            FailureKind.EXCEPTION,
            "1.7e+308",
        ),
        ("def reward(distance): pass", FailureKind.EXCEPTION, "return"),
        ("def reward(distance): return 1 / (distance - distance)", FailureKind.EXCEPTION, "division"),
    ],
)
def test_a_broken_contract_is_told_in_words(tmp_path: Path, text: str, kind: FailureKind, said: str) -> None:
    exam = examine(tmp_path, text)
    assert exam.failure is not None
    assert exam.failure.kind is kind
    assert said in exam.failure.message


def test_better_drives_are_paid_more(examined: Callable[[str], RewardEvidence]) -> None:
    assert all(pair.is_ordered for pair in examined("progress").behaviours)
    wrong = examined("alive")
    assert not all(pair.is_ordered for pair in wrong.behaviours)
    assert "spinning" in wrong.explain("ordered") or "turning" in wrong.explain("ordered")


@pytest.mark.parametrize(
    ("name", "loop"),
    [("one-sided", "forward and back"), ("turning", "spinning"), ("moving", "forward and back")],
)
def test_loops_that_pay_are_named(examined: Callable[[str], RewardEvidence], name: str, loop: str) -> None:
    exam = examined(name)
    assert any(loop in each.name for each in exam.loops if each.is_profitable)
    assert re.search(r"forever earns|each time round", exam.explain("loops"))
    assert not any(each.is_profitable for each in examined("shaped").loops)


ARRIVING = "1000.0 * reached - collided"


@pytest.mark.parametrize(
    ("paid", "pays"),
    [
        (f"10.0 * max(0.0, previous_distance - distance) + {ARRIVING}", True),
        (f"previous_distance - distance + {ARRIVING}", False),
        (f"previous_distance - 0.98 * distance + {ARRIVING}", False),
        (f"previous_distance - distance - 0.05 * (move > 2) + {ARRIVING}", False),
        (f"max(0.0, previous_distance - distance) - 0.3 + {ARRIVING}", False),
        (f"(1.0 if distance < previous_distance else -1.0) + {ARRIVING}", False),
    ],
    ids=[
        "it never scolds",
        "change",
        "potential with discount",
        "turning costs",
        "every step costs more",
        "nearer or not",
    ],
)
def test_a_loop_that_pays_is_not_hidden_by_what_arriving_pays(tmp_path: Path, paid: str, pays: bool) -> None:
    text = f"def reward(distance, previous_distance, reached, collided, move):\n    return {paid}\n"
    exam = examine(tmp_path, text)
    assert any(each.is_profitable for each in exam.loops) == pays
    assert ("each time round" in exam.explain("loops")) == pays


@pytest.mark.parametrize(("factor", "is_paid"), [(1e-9, False), (1e-3, False), (1.0, True)])
def test_what_is_paid_for_the_way_is_noticed(tmp_path: Path, factor: float, is_paid: bool) -> None:
    exam = examine(
        tmp_path, f"def reward(reached, distance):\n    return 10.0 * reached - {factor} * distance\n"
    )
    assert all(each.is_ordered for each in exam.approaches) == is_paid
    assert any(each.is_ordered for each in exam.approaches) == is_paid
    assert is_paid or "nobody learns" in exam.explain("shaped")


def test_a_longer_horizon_changes_what_pays() -> None:
    """Why the discount belongs to the task: staying alive pays 50 at 0.98 and 2 at 0.5."""
    short = replace(ROOM, discount=0.5)
    model = build_model(short)
    rewards = np.where(model.reached, 10.0, np.where(model.hit, 0.0, 1.0))
    assert evaluate_policy(value_iteration(model, rewards)).success == pytest.approx(1.0)


@pytest.mark.parametrize("discount", [0.01, 0.98, 0.999])
@pytest.mark.parametrize("largest", [LARGEST_REWARD, 1.7e308, 5e-324, -0.0, np.nan, np.inf])
def test_the_iteration_ends_whatever_the_rewards_are(largest: float, discount: float) -> None:
    model = build_model(replace(ROOM, discount=discount))
    signs = np.where(np.arange(model.states * 4).reshape(-1, 4) % 3, 1.0, -1.0)
    with np.errstate(all="ignore"):
        policy = value_iteration(model, signs * largest)
    if abs(largest) <= LARGEST_REWARD:
        assert np.isfinite(policy.values).all()
        assert policy.best.any(axis=1).all()


BRIEF = RewardTrainingParams(steps=20_000, seeds=1, episodes=30)


@pytest.mark.long
def test_training_tells_a_reward_that_teaches_from_one_that_does_not(tmp_path: Path) -> None:
    """Judged by the true goal: being paid for being there teaches nothing."""
    good = examine(tmp_path, source("progress")).success_after_training(BRIEF)
    bad = examine(tmp_path, source("alive")).success_after_training(BRIEF)
    assert good > 0.25
    assert bad < 0.1


@pytest.mark.long
def test_training_ends_where_the_reward_fails(tmp_path: Path) -> None:
    broken = examine(tmp_path, "n = [0]\ndef reward(distance):\n    n[0] += 1\n    return 1 / (n[0] != 5000)")
    assert broken.failure is None
    assert broken.success_after_training(BRIEF) == 0.0


@pytest.mark.parametrize(
    ("parameters", "body", "least", "most"),
    [
        ("reached", "10.0 * reached", 0, 0),
        ("reached", "-1.0", 0, 0),
        ("move", "1.0 * (move in (1, 2))", 0.3, 0.9),
        ("distance", "-distance", 1, 1),
        ("distance, previous_distance", "previous_distance - distance", 1, 1),
        ("to_go, previous_to_go", "previous_to_go - to_go - 0.01", 1, 1),
        ("to_go, previous_to_go", "previous_to_go - 0.98 * to_go", 1, 1),
        ("to_go, previous_to_go", "to_go - previous_to_go", 0, 0),
    ],
)
@pytest.mark.parametrize("task", [SMALL, ROOM], ids=["small", "room"])
def test_who_comes_nearer_without_arriving_is_paid_more(
    tmp_path: Path, task: GridTask, parameters: str, body: str, least: float, most: float
) -> None:
    exam = examine(tmp_path, f"def reward({parameters}): return {body}", task)
    assert len(exam.approaches) >= 6
    assert least <= np.mean([pair.is_ordered for pair in exam.approaches]) <= most
