"""Challenges without driving: naive answers earn nothing, the best ones gold, and every mistake is said."""

from __future__ import annotations

import math
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest
from click.testing import CliRunner

from kit.cli.game import command
from kit.layers.planning import solve_layers
from kit.layers.requirements_file import read_requirements
from kit.school.game.challenge_answers import begin_repair, prepare_answer, read_answer
from kit.school.game.challenges import (
    GOLD_STEPS,
    Challenge,
    ChallengeError,
    DevicesTask,
    ExploitTask,
    LayersTask,
    RepairTask,
    TrainingTask,
    all_challenges,
    best_moves,
    challenge_medals,
    fewest_lasers,
    find_challenge,
    judge,
    judge_assignment,
    judge_training,
    naive_lasers,
    naive_plan,
    paid_for,
    shortest_moves,
)
from kit.school.game.player_progress import Medal
from kit.school.lessons.reading import lesson_names, lessons_folder
from kit.school.progress import ProgressJournal

EXPLOITS = [each for each in all_challenges() if isinstance(each.task, ExploitTask)]
PLANS = [each for each in all_challenges() if isinstance(each.task, LayersTask)]
DEVICES = [each for each in all_challenges() if isinstance(each.task, DevicesTask)]
REPAIRS = [each for each in all_challenges() if isinstance(each.task, RepairTask)]
SOLUTIONS = Path(__file__).parents[2] / "solutions"
STARTER = lessons_folder() / "11-rewards" / "your_reward" / "starter.py"
"""A reward of one's own as it is handed out: always 0."""
TRAININGS = [each for each in all_challenges() if isinstance(each.task, TrainingTask)]


def test_challenges_name_lessons_that_exist() -> None:
    assert {each.lesson for each in all_challenges()} <= set(lesson_names())
    assert all((EXPLOITS, PLANS, TRAININGS, DEVICES, REPAIRS))


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
    with pytest.raises(ChallengeError, match="not a move"):
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


OWN_REWARD = """
def reward(to_go, previous_to_go, reached, collided):
    return 2.0 * (previous_to_go - to_go) + reached - collided
"""
TUNED = ("--worlds", "4", "--learning-rate", "0.003")
SEEDS = ("0", "1", "2")
"""One may be unlucky, and another machine calculates otherwise in the last digits."""


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
        return judge(challenge, name, tmp_path / "runs").medal

    budget = challenge.task.max_steps
    given = () if not challenge.task.own_reward else ("--reward", str(STARTER))
    assert medal("naive", "--steps", str(budget - budget % 10_000), *given) is Medal.NONE
    steps = str(int(GOLD_STEPS * budget) // 1024 * 1024)
    assert any(
        medal(f"tuned{seed}", "--steps", steps, "--seed", seed, *TUNED, *reward) is Medal.GOLD
        for seed in SEEDS
    )


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


@pytest.mark.parametrize("challenge", DEVICES, ids=lambda each: each.id)
def test_a_laser_at_every_place_earns_nothing_and_the_fewest_gold(challenge, tmp_path: Path) -> None:
    task = challenge.task

    def worth(lasers: Sequence[tuple[int, int]]) -> Medal:
        return judge(challenge, " ".join(f"{row},{column}" for row, column in lasers), tmp_path).medal

    best, naive = fewest_lasers(task), naive_lasers(task)
    assert len({len(line) for line in task.grid}) == 1
    assert len(best) + 2 < len(naive)
    assert worth(naive) is Medal.NONE
    assert worth(best) is Medal.GOLD
    assert worth((*best, best[0])) is Medal.SILVER
    assert worth((*best, *best[:1] * 2)) is Medal.BRONZE
    assert worth(best[1:]) is Medal.NONE
    tidy: list[
        tuple[int, int]
    ] = []  # always the laser that sees most of what is left: no gold for the first idea
    while missed := set(task.places) - task.seen_from(tuple(tidy)):
        tidy.append(max(task.floor, key=lambda square: len(missed & task.seen_from((square,)))))
    assert worth(tidy) < Medal.GOLD
    for wrong in ("", "1", "1,1,1", "-1,2", "0,0", "a,b", "99999,1", "1,1 " * 101):
        with pytest.raises(ChallengeError):
            judge(challenge, wrong, tmp_path)


def test_walls_are_not_seen_through() -> None:
    task = DevicesTask(("#####", "#a#b#", "#...#", "#####"))
    assert not task.sees((1, 1), (1, 3))
    assert task.sees((2, 2), (2, 1))
    assert all(task.sees(a, b) == task.sees(b, a) for a in task.floor for b in task.floor)
    assert len(fewest_lasers(task)) == 1


@pytest.mark.long
@pytest.mark.parametrize("challenge", REPAIRS, ids=lambda each: each.id)
def test_a_program_is_repaired_against_the_clock(challenge, tmp_path: Path) -> None:
    with ProgressJournal(tmp_path) as journal:
        file, seconds = begin_repair(journal, challenge, tmp_path / "challenges")
        assert seconds == 0.0
        faulty = file.read_text()
        broken = judge(challenge, str(file), tmp_path, 1.0)
        assert broken.medal is Medal.NONE  # the naive answer: as it was
        solution = (
            SOLUTIONS / challenge.task.folder.relative_to(lessons_folder()) / "solution.py"
        ).read_text()
        file.write_text(solution)
        again, later = begin_repair(journal, challenge, tmp_path / "challenges", time.time() + 1000)
        assert again.read_text() == solution  # nothing is overwritten
        assert later == pytest.approx(1000, abs=30)  # and the clock goes on
        assert challenge_medals(journal.events()) == {challenge.id: Medal.NONE}
    task = challenge.task
    for when, medal in ((task.gold_s, Medal.GOLD), (task.silver_s, Medal.SILVER), (math.inf, Medal.BRONZE)):
        assert judge(challenge, str(file), tmp_path, when).medal is medal
    different = [a for a, b in zip(faulty.splitlines(), solution.splitlines(), strict=False) if a != b]
    assert len(different) >= 5  # more than one fault, so that it takes a while
    with pytest.raises(ChallengeError, match="Hand in"):
        judge(challenge, str(tmp_path), tmp_path, 1.0)


@pytest.mark.parametrize("challenge", [*EXPLOITS, *DEVICES, *PLANS], ids=lambda each: each.id)
def test_an_answers_file_begins_with_the_naive_answer_and_is_kept(challenge, tmp_path: Path) -> None:
    with ProgressJournal(tmp_path) as journal:
        file, seconds = prepare_answer(journal, challenge, tmp_path / "challenges")
        assert file is not None
        assert seconds == math.inf  # no clock
        judgement = judge(challenge, read_answer(challenge, file), tmp_path)
        assert judgement.medal is Medal.NONE
        comparison = judgement.comparison
        if comparison is None:  # the way that was wanted: the target is reached
            assert isinstance(challenge.task, ExploitTask)
        else:
            assert comparison.answer == dict(comparison.others)["naive answer"]
        file.write_text("mine\n")
        assert prepare_answer(journal, challenge, tmp_path / "challenges")[0] == file
        assert file.read_text() == "mine\n"
        file.unlink()
        with pytest.raises(ChallengeError, match=file.name):
            judge(challenge, read_answer(challenge, file), tmp_path)


def test_a_training_has_no_file(tmp_path: Path) -> None:
    with ProgressJournal(tmp_path) as journal:
        assert prepare_answer(journal, TRAININGS[0], tmp_path)[0] is None


@pytest.mark.parametrize("challenge", REPAIRS, ids=lambda each: each.id)
def test_a_check_that_nobody_waits_for_ends(challenge, tmp_path: Path) -> None:
    class LeftError(Exception):
        pass

    def leave(_: str) -> None:
        raise LeftError

    with ProgressJournal(tmp_path) as journal:
        file, _ = begin_repair(journal, challenge, tmp_path / "challenges")
        with pytest.raises(LeftError):
            judge(challenge, str(file), tmp_path, 1.0, leave)
