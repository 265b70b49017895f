"""Policies: the shortest way earns nothing where the floor is slippery, the best policy gold; values are exact."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import numpy as np
import pytest

from kit.document.rows import row_text
from kit.school.game.board import MOVES, find_cell, step
from kit.school.game.challenge import AnswerError, AnswerSubmission
from kit.school.game.challenge_kinds.policy import (
    GOAL,
    PIT,
    SIDES,
    PolicyTask,
    best_policy,
    format_policy,
    naive_policy,
    read_policy,
    value_of,
)
from kit.school.game.challenges import all_challenges
from kit.school.game.medal import Medal

POLICIES = [each for each in all_challenges() if isinstance(each.task, PolicyTask)]


@pytest.mark.parametrize("challenge", POLICIES, ids=lambda each: each.id)
def test_the_best_policy_earns_gold_and_the_shortest_way_nothing(challenge) -> None:
    task = challenge.task

    def worth(text: str) -> Medal:
        return task.judge(AnswerSubmission(text, Path())).medal

    best, naive = (format_policy(task, each(task)) for each in (best_policy, naive_policy))
    assert worth(best) is Medal.GOLD
    assert worth(naive) is Medal.NONE
    assert read_policy(task, best) == best_policy(task)
    for wrong in ("", best.replace("r", "x"), best.replace("\n", "", 1)):
        with pytest.raises(AnswerError):
            worth(wrong)


@pytest.mark.parametrize("challenge", POLICIES, ids=lambda each: each.id)
def test_the_value_of_a_policy_is_what_its_episodes_are_paid(challenge) -> None:
    task, policy = challenge.task, best_policy(challenge.task)
    random = np.random.default_rng(3)
    returns = []
    for _ in range(1500):
        cell, total, weight = find_cell(task.grid, "S"), 0.0, 1.0
        for _ in range(400):
            side = random.random()
            move = policy[cell]
            way = SIDES[move][0] if side < task.slip else SIDES[move][1] if side < 2 * task.slip else move
            cell = step(task.grid, cell, way)
            sign = task.grid[cell[0]][cell[1]]
            total += weight * (task.step_pay + (sign == GOAL) - (sign == PIT))
            weight *= task.discount
            if sign in GOAL + PIT:
                break
        returns.append(total)
    assert value_of(task, policy) == pytest.approx(
        np.mean(returns), abs=4 * np.std(returns) / len(returns) ** 0.5
    )


@pytest.mark.parametrize("arrow", MOVES)
def test_a_policy_that_may_never_end_is_worth_less_than_the_shortest_way(arrow: str) -> None:
    task = next(each.task for each in POLICIES if each.task.discount == 1.0)
    lost = dict.fromkeys(task.cells, arrow)
    assert (
        value_of(task, lost) < value_of(task, naive_policy(task)) < value_of(task, best_policy(task)) + 1e-9
    )


@pytest.mark.parametrize("looks_alike", [False, True])
def test_no_policy_is_better_than_the_best(looks_alike: bool) -> None:
    task = PolicyTask(("#####", "#S.G#", "#X.X#", "#####"), 0.15, -0.05, 0.95, looks_alike)
    best = value_of(task, best_policy(task))
    every = (dict(zip(task.cells, arrows, strict=True)) for arrows in product(MOVES, repeat=len(task.cells)))
    if looks_alike:
        every = (
            policy
            for policy in every
            if len({(task.look(cell), arrow) for cell, arrow in policy.items()})
            == len({task.look(cell) for cell in policy})
        )
    assert best == pytest.approx(max(value_of(task, policy) for policy in every))


def test_cells_that_look_alike_share_an_arrow() -> None:
    challenge = next(each for each in POLICIES if each.task.looks_alike)
    task = challenge.task
    board = task.board("")
    before = read_policy(task, board.answer)
    board.move(0, -1)
    board.mark()
    after = read_policy(task, board.answer)
    changed = {cell for cell in before if before[cell] != after[cell]}
    assert len(changed) > 1
    assert len({task.look(cell) for cell in changed}) == 1
    board.undo()
    assert read_policy(task, board.answer) == before
    lines = list(board.answer)
    (cell, *_) = changed
    at = cell[0] * (len(task.grid[0]) + 1) + cell[1]
    lines[at] = "l" if lines[at] != "l" else "r"
    with pytest.raises(AnswerError, match="looks like"):
        task.judge(AnswerSubmission("".join(lines), Path()))


def test_an_episode_that_may_never_end_is_refused_where_nothing_is_discounted() -> None:
    task = next(each.task for each in POLICIES if each.task.discount == 1)
    upward = dict.fromkeys(task.cells, "u")
    assert value_of(task, upward) == -np.inf
    with pytest.raises(AnswerError, match="never end"):
        task.judge(AnswerSubmission(format_policy(task, upward), Path()))
    for arrow in "ldr":  # a slip leads into a pit at last
        assert -10 < value_of(task, dict.fromkeys(task.cells, arrow)) < 0
    assert 0 < value_of(task, best_policy(task)) < 1


@pytest.mark.parametrize("challenge", POLICIES, ids=lambda each: each.id)
def test_no_medal_is_given_for_next_to_nothing_and_a_return_is_rounded_alike_everywhere(challenge) -> None:
    task = challenge.task
    board = task.board(format_policy(task, naive_policy(task)))
    comparison = board.judgement().comparison
    assert comparison is not None
    (_, naive), (_, best) = comparison.others
    lowest = comparison.rungs[0][1]
    assert lowest - naive >= 0.2 * (best - naive)
    shown = f"{naive:.2f}"
    assert shown in board.judgement().text
    assert any(f"return {shown} " in row_text(each) for each in board.rows())
