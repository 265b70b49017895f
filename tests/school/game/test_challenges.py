"""Challenges without driving: naive answers earn nothing, and every mistake is said."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from click.testing import CliRunner

from kit.cli.game import command
from kit.school.game.challenge import AnswerError, AnswerSubmission, ChallengeTask
from kit.school.game.challenge_kinds import challenge_kinds
from kit.school.game.challenge_kinds.exploit import best_moves
from kit.school.game.challenges import all_challenges, find_challenge, prepare_answer
from kit.school.game.medal import Medal
from kit.school.lessons.reading import lesson_names
from kit.school.progress import ProgressJournal

WRITTEN = [each for each in all_challenges() if each.task.answer_file]


def test_every_kind_has_a_challenge_and_every_challenge_a_lesson() -> None:
    assert {each.task.kind for each in all_challenges()} == set(challenge_kinds)
    assert {each.lesson for each in all_challenges()} <= set(lesson_names())
    assert len({each.task_text for each in all_challenges()}) == len(all_challenges()), "an idea of its own"


def test_the_verb_lists_shows_judges_and_keeps_the_best(tmp_path: Path) -> None:
    challenge = next(each for each in all_challenges() if each.task.kind == "exploit")

    def said(*words: str) -> str:
        result = CliRunner().invoke(command, ["--workspace", str(tmp_path), "puzzle", *words])
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


@pytest.mark.parametrize("challenge", WRITTEN, ids=lambda each: each.id)
def test_the_verb_takes_an_answers_file_wherever_it_lies(challenge, tmp_path: Path) -> None:
    file = tmp_path / f"elsewhere{Path(challenge.task.answer_file).suffix}"
    written = challenge.task.prepare(tmp_path / "challenges", ())
    assert written is not None
    file.write_bytes(written.read_bytes())
    assert (
        challenge.task.judge(AnswerSubmission(challenge.task.parse_answer(str(file)), tmp_path)).medal
        is Medal.NONE
    )
    words = ["--workspace", str(tmp_path), "puzzle", challenge.id, str(file)]
    result = CliRunner().invoke(command, words)
    assert (result.exit_code, "no medal" in result.output) == (0, True), result.output
    file.unlink()
    missing = CliRunner().invoke(command, words)
    assert missing.exit_code == 2
    assert str(file) in missing.output.replace("\n", "")


def test_moves_may_be_longer_than_a_files_name() -> None:
    task = next(each.task for each in all_challenges() if each.task.kind == "exploit")
    assert task.parse_answer("lr" * 5000) == "lr" * 5000


@pytest.mark.parametrize("challenge", WRITTEN, ids=lambda each: each.id)
def test_an_answers_file_begins_with_the_naive_answer_and_is_kept(challenge, tmp_path: Path) -> None:
    task = challenge.task
    with ProgressJournal(tmp_path) as journal:
        file, seconds = prepare_answer(journal, challenge, tmp_path / "challenges")
        assert file is not None
        assert seconds == math.inf  # no clock
        judgement = task.judge(AnswerSubmission(task.read_answer(file), tmp_path))
        assert judgement.medal is Medal.NONE
        if judgement.comparison is not None and len(judgement.comparison.others) == 2:
            assert judgement.comparison.answer == judgement.comparison.others[0][1]
        file.write_text("mine\n")
        assert prepare_answer(journal, challenge, tmp_path / "challenges")[0] == file
        assert file.read_text() == "mine\n"
        file.unlink()
        with pytest.raises(AnswerError, match=file.name):
            task.judge(AnswerSubmission(task.read_answer(file), tmp_path))


@pytest.mark.parametrize("challenge", all_challenges(), ids=lambda each: each.id)
def test_only_a_kind_without_a_file_has_none(challenge, tmp_path: Path) -> None:
    with ProgressJournal(tmp_path) as journal:
        file, seconds = prepare_answer(journal, challenge, tmp_path)
        makes_file = challenge.task.answer_file or type(challenge.task).prepare is not ChallengeTask.prepare
        assert (file is None) == (not makes_file)
        assert math.isinf(seconds) == (challenge.task.clock is None)
