"""Repairing a program: the clock begins with the first look, and the check decides."""

from __future__ import annotations

import math
import time
from pathlib import Path

import pytest

from kit.school.game.challenge import AnswerError, AnswerSubmission
from kit.school.game.challenge_kinds.repair import RepairTask
from kit.school.game.challenges import all_challenges, challenge_medals, prepare_answer
from kit.school.game.medal import Medal
from kit.school.lessons.reading import lessons_folder
from kit.school.progress import ProgressJournal

REPAIRS = [each for each in all_challenges() if isinstance(each.task, RepairTask)]
SOLUTIONS = Path(__file__).parents[3] / "solutions"


@pytest.mark.long
@pytest.mark.parametrize("challenge", REPAIRS, ids=lambda each: each.id)
def test_a_program_is_repaired_against_the_clock(challenge, tmp_path: Path) -> None:
    with ProgressJournal(tmp_path) as journal:
        file, seconds = prepare_answer(journal, challenge, tmp_path / "challenges")
        assert seconds == 0.0
        faulty = file.read_text()
        broken = challenge.task.judge(AnswerSubmission(str(file), tmp_path, 1.0))
        assert broken.medal is Medal.NONE  # the naive answer: as it was
        solution = (
            SOLUTIONS / challenge.task.folder.relative_to(lessons_folder()) / "solution.py"
        ).read_text()
        file.write_text(solution)
        again, later = prepare_answer(journal, challenge, tmp_path / "challenges", time.time() + 1000)
        assert again.read_text() == solution  # nothing is overwritten
        assert later == pytest.approx(1000, abs=30)  # and the clock goes on
        assert challenge_medals(journal.events()) == {challenge.id: Medal.NONE}
    task = challenge.task
    gold_s, silver_s = task.clock
    for when, medal in ((gold_s, Medal.GOLD), (silver_s, Medal.SILVER), (math.inf, Medal.BRONZE)):
        assert task.judge(AnswerSubmission(str(file), tmp_path, when)).medal is medal
    different = [a for a, b in zip(faulty.splitlines(), solution.splitlines(), strict=False) if a != b]
    assert len(different) >= 5  # more than one fault, so that it takes a while
    with pytest.raises(AnswerError, match="Hand in"):
        challenge.task.judge(AnswerSubmission(str(tmp_path), tmp_path, 1.0))


@pytest.mark.parametrize("challenge", REPAIRS, ids=lambda each: each.id)
def test_a_check_that_nobody_waits_for_ends(challenge, tmp_path: Path) -> None:
    class LeftError(Exception):
        pass

    def leave(_: str) -> None:
        raise LeftError

    with ProgressJournal(tmp_path) as journal:
        file, _ = prepare_answer(journal, challenge, tmp_path / "challenges")
        with pytest.raises(LeftError):
            challenge.task.judge(AnswerSubmission(str(file), tmp_path, 1.0, leave))
