"""Beating a layer plan: a layer for every line earns nothing, the fewest gold."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from kit.layers.planning import solve_layers
from kit.layers.requirements_file import read_requirements
from kit.school.game.challenge import AnswerError, AnswerSubmission
from kit.school.game.challenge_kinds.layers import LayersTask, judge_assignment, naive_plan
from kit.school.game.challenges import all_challenges
from kit.school.game.medal import Medal

PLANS = [each for each in all_challenges() if isinstance(each.task, LayersTask)]


@pytest.mark.parametrize("challenge", PLANS, ids=lambda each: each.id)
def test_a_plan_with_a_layer_for_every_line_earns_nothing(challenge, tmp_path: Path) -> None:
    case = read_requirements(challenge.task.file).case
    naive, best = naive_plan(case), solve_layers(case).assignment
    assert judge_assignment(challenge.task, naive).medal is Medal.NONE
    assert "enough" in judge_assignment(challenge.task, naive).text  # it does what is asked, with too many
    assert judge_assignment(challenge.task, best).medal is Medal.GOLD
    assert judge_assignment(challenge.task, replace(best, layers=best.layers[:-1])).medal is Medal.NONE
    file = tmp_path / "plan.yaml"
    rows = [f"  {layer.name}: [{', '.join(sorted(layer.members))}]" for layer in best.layers]
    watched = [f"  {laser}: [{', '.join(names)}]" for laser, names in best.watches.items()]
    file.write_text("\n".join(["layers:", *rows, "lasers:", *watched, ""]))
    assert challenge.task.judge(AnswerSubmission(str(file), tmp_path)).medal is Medal.GOLD
    with pytest.raises(AnswerError, match="no such file"):
        challenge.task.judge(AnswerSubmission(str(tmp_path / "none.yaml"), tmp_path))


@pytest.mark.parametrize("challenge", PLANS, ids=lambda each: each.id)
def test_a_plan_can_be_made_by_keys(challenge, tmp_path: Path) -> None:
    """The best plan, entered mark by mark on the board."""
    task = challenge.task
    case = read_requirements(task.file).case
    best = solve_layers(case).assignment
    names = [*case.names, *(laser.name for laser in case.lasers)]
    board = task.board("")
    assert board.judgement().medal is Medal.NONE
    for column, layer in enumerate(best.layers):
        lasers = {laser for laser, watched in best.watches.items() if layer.name in watched}
        for name in sorted(layer.members | lasers):
            board.move(-1000, -1000)
            board.move(column, names.index(name))
            board.mark()
    assert board.judgement().medal is Medal.GOLD
    file = tmp_path / task.answer_file
    file.write_text(board.answer)
    assert task.judge(AnswerSubmission(task.read_answer(file), tmp_path)).medal is Medal.GOLD
    again = task.board(task.read_answer(file))
    assert again.judgement().medal is Medal.GOLD
    again.undo()
    board.undo()
    assert board.judgement().medal is not Medal.GOLD
