"""``kit quiz`` line by line: what is typed, what is answered, what is kept, and what a kill leaves."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from kit.cli import main
from kit.school.progress import EventKind, ProgressEvent, ProgressJournal
from kit.school.quiz.items import QuizItem
from tests.kit_content import kit_bank

BANK = kit_bank()


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return tmp_path / "workspace"


def quiz(folder: Path, *words: str, said: str = "") -> Result:
    return CliRunner().invoke(main, ["quiz", *words], input=said, env={"KIT_WORKSPACE": str(folder)})


def answers(folder: Path) -> list[ProgressEvent]:
    with ProgressJournal(folder) as progress:
        return progress.events(EventKind.ANSWER)


def asked(output: str) -> list[QuizItem]:
    """The items whose questions stand in the output, in order."""
    flat = " ".join(output.split())
    places = {flat.find(" ".join(item.question.split())): item for item in BANK.items}
    return [places[at] for at in sorted(places) if at >= 0]


def test_from_the_first_question_to_the_result(folder: Path) -> None:
    result = quiz(folder, said="1\n4\n" * 12)
    assert result.exit_code == 0
    assert "question 12 of 12" in result.output
    given = answers(folder)
    assert [event.subject for event in given] == [item.id for item in asked(result.output)]
    assert {event.subject for event in given} == {item.id for item in BANK.quiz_items}
    right = sum(event.content["right"] for event in given)
    assert f"{right} of 12 right" in result.output
    assert f"{right} of 12" in quiz(folder, "--scores").output
    assert max(map(len, result.output.splitlines())) <= 80


def test_a_wrong_answer_gets_feedback(folder: Path) -> None:
    first = asked(quiz(folder, said="q\n").output)[0]
    wrong = (first.right_option + 1) % 3
    output = " ".join(quiz(folder, said=f"{wrong + 1}\n3\n").output.split())
    assert " ".join(first.options[wrong].feedback.split()) in output
    assert f"Not right: option {first.right_option + 1} is." in output


def test_a_right_answer_gets_feedback(folder: Path) -> None:
    first = asked(quiz(folder, said="q\n").output)[0]
    output = " ".join(quiz(folder, said=f"{first.right_option + 1}\n\n2\n").output.split())
    assert "Say how sure you are" in output
    assert " ".join(first.options[first.right_option].feedback.split()) in output
    assert [event.content["confidence"] for event in answers(folder)] == [2]


def test_not_sure_and_blank(folder: Path) -> None:
    result = quiz(folder, said="0\n\nx\nx\nx\n0\n?\n")
    kept = [(event.content["chosen"], event.content["not_sure"]) for event in answers(folder)]
    assert kept == [(None, True), (None, False), (None, True)]
    assert result.output.count("x once more leaves it blank") == 2
    assert "0 says that you are not sure" in result.output
    assert "Choose 1 to 3" in result.output
    assert all(event.content["confidence"] is None for event in answers(folder))


def test_it_goes_on_where_one_left(folder: Path) -> None:
    first = quiz(folder, said="1\n2\n2\n2\nq\n")
    assert "2 of 12 answered" in first.output
    second = quiz(folder, said="3\n")  # the confidence is not said: not kept
    assert "You continue at question 3." in second.output
    assert len(answers(folder)) == 2
    assert asked(second.output)[0] == asked(first.output)[2]


def test_a_lesson_by_number_or_name_and_its_second_round(folder: Path) -> None:
    count = len(BANK.lesson_items("07-who-collides-who-sees"))
    whole = "2\n3\n" * count
    assert quiz(folder, "7", said=whole).exit_code == 0
    assert len(answers(folder)) == count
    again = quiz(folder, "who-collides-who-sees", said=whole)
    assert re.search(r"kit quiz [A-Z]\d --again", again.output)
    assert len(answers(folder)) == count
    quiz(folder, "07", "--again", said=whole)
    assert len(answers(folder)) == 2 * count


def test_today(folder: Path) -> None:
    assert "Nothing is scheduled" in quiz(folder, "--today").output
    quiz(folder, "1", said="1\n1\n")
    assert "Next: tomorrow" in quiz(folder, "--today").output


def test_mistakes_end_with_a_way_out(folder: Path) -> None:
    unknown = quiz(folder, "08-fewest-layer")
    assert unknown.exit_code == 2
    assert "B5" in unknown.output
    assert quiz(folder, "7", "--today").exit_code == 2


def test_looking_at_scores_makes_nothing(folder: Path) -> None:
    assert quiz(folder, "--scores").exit_code == 0
    assert not folder.exists()


def test_a_damaged_journal_is_reported_and_set_aside(folder: Path) -> None:
    quiz(folder, said="1\n1\n")
    (folder / "progress.db").write_bytes(b"nonsense" * 1000)
    result = quiz(folder, said="1\n1\n")
    assert result.exit_code == 0
    assert "damaged" in result.output
    assert list(folder.glob("progress.damaged-*"))
    assert len(answers(folder)) == 1


@pytest.mark.long_cases("1")
@pytest.mark.parametrize("after", [1, 3, 7])
def test_a_kill_loses_no_confirmed_answer(folder: Path, after: int) -> None:
    """Killed as soon as so many verdicts have come, while the next answer is on its way."""
    command = [sys.executable, "-u", "-m", "kit", "quiz"]
    environment = {**os.environ, "KIT_WORKSPACE": str(folder), "PYTHONUNBUFFERED": "1"}
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment
    ) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdin.write("1\n3\n" * 12)
        process.stdin.flush()
        told = 0
        for line in process.stdout:
            told += bool(re.match(r"Right\.|Not right", line))
            if told == after:
                break
        process.kill()
    kept = len(answers(folder))
    assert after <= kept <= 12
    result = quiz(folder, said="q\n")
    assert f"{kept} of 12" in result.output
