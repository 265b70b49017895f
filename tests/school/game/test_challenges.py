"""Challenges without driving: naive answers earn nothing, the best ones gold, and every mistake is said."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from click.testing import CliRunner

from kit.cli.game import command
from kit.layers.planning import solve_layers
from kit.layers.requirements_file import read_requirements
from kit.school.game.challenges import (
    ChallengeError,
    ExploitTask,
    LayersTask,
    TrainingTask,
    all_challenges,
    best_moves,
    find_challenge,
    judge,
    judge_assignment,
    judge_training,
    naive_plan,
    paid_for,
    shortest_moves,
)
from kit.school.game.medals import Medal
from kit.school.lessons.reading import lesson_names

EXPLOITS = [each for each in all_challenges() if isinstance(each.task, ExploitTask)]
PLANS = [each for each in all_challenges() if isinstance(each.task, LayersTask)]
TRAININGS = [each for each in all_challenges() if isinstance(each.task, TrainingTask)]


def test_challenges_name_lessons_that_exist() -> None:
    assert {each.lesson for each in all_challenges()} <= set(lesson_names())
    assert all((EXPLOITS, PLANS, TRAININGS))


@pytest.mark.parametrize("challenge", EXPLOITS, ids=lambda each: each.id)
def test_a_reward_is_broken_and_not_by_the_shortest_way(challenge, tmp_path: Path) -> None:
    task = challenge.task
    shortest, best = shortest_moves(task), best_moves(task)
    assert paid_for(task, shortest)[1]
    assert judge(challenge, shortest, tmp_path).medal is Medal.NONE
    assert judge(challenge, "", tmp_path).medal is Medal.NONE
    assert not paid_for(task, best)[1]
    assert judge(challenge, best, tmp_path).medal is Medal.GOLD
    assert judge(challenge, best[: len(best) * 9 // 10], tmp_path).medal < Medal.GOLD
    with pytest.raises(ChallengeError, match="no move"):
        judge(challenge, "lrx", tmp_path)
    with pytest.raises(ChallengeError, match="too many"):
        judge(challenge, "l" * (task.max_moves + 1), tmp_path)
    mended = replace(task, farther=-task.nearer / task.discount)  # what a step pays, the step back takes
    assert paid_for(mended, best_moves(mended))[0] < paid_for(mended, shortest)[0]


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
    assert judge(challenge, str(file), tmp_path).medal is Medal.GOLD
    with pytest.raises(ChallengeError, match="no such file"):
        judge(challenge, str(tmp_path / "none.yaml"), tmp_path)


@pytest.mark.parametrize("challenge", TRAININGS, ids=lambda each: each.id)
def test_a_training_counts_steps_and_successes(challenge, tmp_path: Path) -> None:
    task, own = challenge.task, challenge.task.own_reward
    budget = task.max_steps
    medals = [
        judge_training(task, steps, 0.95, has_own_reward=own).medal
        for steps in (budget + 1, budget, budget // 2, budget // 4)
    ]
    assert medals == [Medal.NONE, Medal.BRONZE, Medal.SILVER, Medal.GOLD]
    assert judge_training(task, 1, task.success - 0.01, has_own_reward=own).medal is Medal.NONE
    if own:
        assert judge_training(task, 1, 1.0, has_own_reward=False).medal is Medal.NONE
    with pytest.raises(ChallengeError):
        judge(challenge, "no-such-run", tmp_path)


def test_the_verb_lists_shows_judges_and_keeps_the_best(tmp_path: Path) -> None:
    challenge = EXPLOITS[0]

    def said(*words: str) -> str:
        result = CliRunner().invoke(command, ["--workspace", str(tmp_path), "challenge", *words])
        assert result.exit_code == 0, result.output
        return result.output

    assert f".  {challenge.id}" in said()
    assert challenge.task.grid[1] in said(challenge.id)
    assert "gold" in said(challenge.id, best_moves(challenge.task))
    assert "no medal" in said(challenge.id, "lr")
    assert f"G  {challenge.id}" in said()
    assert find_challenge(challenge.id) is challenge
    with pytest.raises(LookupError, match=challenge.id):
        find_challenge(challenge.id[:-1])
