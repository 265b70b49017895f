"""Training within a budget: steps, successes and whose reward it was."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from kit.school.game.challenge import AnswerError, AnswerSubmission, Challenge
from kit.school.game.challenge_kinds.training import GOLD_STEPS, TrainingTask, judge_training
from kit.school.game.challenges import all_challenges
from kit.school.game.medal import Medal
from kit.school.lessons.reading import lessons_folder

TRAININGS = [each for each in all_challenges() if isinstance(each.task, TrainingTask)]
STARTER = lessons_folder() / "11-rewards" / "your_reward" / "starter.py"
"""A reward of one's own as it is handed out: always 0."""
OWN_REWARD = """
def reward(to_go, previous_to_go, reached, collided):
    return 2.0 * (previous_to_go - to_go) + reached - collided
"""
TUNED = ("--worlds", "4", "--learning-rate", "0.003")
SEEDS = ("0", "1", "2")
"""One may be unlucky, and another machine calculates otherwise in the last digits."""


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
    with pytest.raises(AnswerError):
        challenge.task.judge(AnswerSubmission("no-such-run", tmp_path))


@pytest.mark.parametrize("challenge", TRAININGS, ids=lambda each: each.id)
def test_the_page_says_with_how_many_steps_each_medal_is_earned(challenge: Challenge) -> None:
    assert isinstance(challenge.task, TrainingTask)
    own = challenge.task.own_reward
    told = [line.split() for line in challenge.task.lines() if "at most" in line]
    for medal, *_, steps, _ in told:
        most = int(steps.replace(",", ""))
        earned = [
            judge_training(challenge.task, count, 1.0, has_own_reward=own).medal for count in (most, most + 1)
        ]
        assert earned[0] is Medal[medal.upper()]
        assert earned[1] < earned[0]
    assert len(told) == 3


@pytest.mark.nightly
@pytest.mark.timeout(900)
@pytest.mark.parametrize("challenge", TRAININGS, ids=lambda each: each.id)
def test_the_kits_settings_earn_nothing_and_settings_that_suit_the_task_gold(
    challenge: Challenge, tmp_path: Path
) -> None:
    assert isinstance(challenge.task, TrainingTask)
    (tmp_path / "mine.py").write_text(OWN_REWARD)
    own = ("--reward", str(tmp_path / "mine.py"))
    reward = own if challenge.task.own_reward else ("--algorithm-reward", "progress")

    def medal(name: str, *options: str) -> Medal:
        command = [sys.executable, "-m", "kit", "train", "turn", "--plain", "--workspace", str(tmp_path)]
        subprocess.run([*command, "--name", name, *options], check=True, capture_output=True, timeout=600)
        return challenge.task.judge(AnswerSubmission(name, tmp_path / "runs")).medal

    budget = challenge.task.max_steps
    given = () if not challenge.task.own_reward else ("--reward", str(STARTER))
    assert medal("naive", "--steps", str(budget - budget % 10_000), *given) is Medal.NONE
    steps = str(int(GOLD_STEPS * budget) // 1024 * 1024)
    assert any(
        medal(f"tuned{seed}", "--steps", steps, "--seed", seed, *TUNED, *reward) is Medal.GOLD
        for seed in SEEDS
    )
