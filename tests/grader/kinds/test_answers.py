"""Answers in a file: what counts as right, what is said to a wrong one, and what is not shown."""

from __future__ import annotations

from pathlib import Path

import pytest

from grader.grading import GradingOptions, grade
from grader.reading import read_assignment
from grader.submission import Submission
from kit.host.sandbox.sandbox_config import Level
from kit.results.grading_result import CriterionStatus, GradingVerdict
from kit.world.problems import WorldError
from tests.cases import every_case

ASSIGNMENT_TEXT = """
title: Words
kind: answers
submit: answers.yaml
level: 0
questions:
  topic: {ask: Which topic?, choices: [cmd_vel, odom, scan]}
  rate: {ask: How often a second?}
  nodes: {ask: Which nodes?, list: true}
checks:
  - {check: answers, id: topic, points: 1, with: {keys: [topic]}}
  - {check: answers, id: all, points: 2}
"""
KEYS = """
answers:
  topic: {right: [cmd_vel], feedback: {odom: That one comes from the robot.}}
  rate: {right: [10], within: 0.5}
  nodes: {right: [/one, /two]}
"""
DESK = GradingOptions(Level.LIMITED, secret=True)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    made = tmp_path / "words"
    made.mkdir()
    (made / "assignment.yaml").write_text(ASSIGNMENT_TEXT)
    (made / "secret.yaml").write_text(KEYS)
    return made


def handed_in(text: str) -> Submission:
    return Submission("ada", "answers.yaml", {"answers.yaml": text.encode()})


@pytest.mark.parametrize(
    ("text", "points"),
    [
        ("topic: cmd_vel\nrate: 10.4\nnodes: [/two, /one]\n", 3.0),
        ("topic: CMD_VEL \nrate: '10'\nnodes: [/one,  /two ]\n", 3.0),
        ("topic: cmd_vel\nrate: 10.6\nnodes: [/one]\n", 1.0 + 2.0 / 3.0),
        ("topic: odom\nrate: ten\nnodes: /one\n", 0.0),
        ("topic:\nrate:\nnodes: []\n", 0.0),
        ("{}\n", 0.0),
    ],
    ids=["right", "written otherwise", "some", "wrong", "blank", "empty"],
)
def test_what_is_right(folder: Path, text: str, points: float) -> None:
    result = grade(read_assignment(folder), handed_in(text), DESK)
    assert result.points == pytest.approx(points)
    assert all(not test.status.value.endswith("error") for test in result.tests)


def test_a_known_mistake_is_answered(folder: Path) -> None:
    result = grade(read_assignment(folder), handed_in("topic: odom\n"), DESK)
    assert "comes from the robot" in result.tests[0].rationale


@pytest.mark.parametrize(
    ("text", "named"),
    [("topic: cmd-vel\n", 'did you mean "cmd_vel"'), ("topic: cmd_vel\nrate: ten\n", "in digits")],
    ids=["no choice", "no number"],
)
def test_an_answer_of_the_wrong_form_costs_its_own_question_alone(
    folder: Path, text: str, named: str
) -> None:
    right = "nodes: [/one, /two]\n"
    result = grade(read_assignment(folder), handed_in(text + right), DESK)
    assert named in " ".join(test.rationale for test in result.tests)
    assert all(test.status is not CriterionStatus.STUDENT_ERROR for test in result.tests)
    assert result.tests[1].points > 0.0


@pytest.mark.parametrize(
    ("rate", "named"),
    [
        ("'10,4'", "10.4"),
        ("20 / 2", "Work it out"),
        ("10 Hz", "without a unit"),
        ("9.26", "One step too few"),
        ("9.255", "One step too few"),
        ("9", ""),
        ("9.3", ""),
        ("8.25", "rounded too far"),
        ("8.2", ""),
    ],
)
def test_a_number_that_is_rounded_or_written_otherwise_is_answered(
    folder: Path, rate: str, named: str
) -> None:
    keys = KEYS.replace(
        "[10], within: 0.5", "[8.2514], within: 0.001, feedback: {'9.255': One step too few.}"
    )
    (folder / "secret.yaml").write_text(keys)
    right = "topic: cmd_vel\nnodes: [/one, /two]\n"
    told = grade(read_assignment(folder), handed_in(f"{right}rate: {rate}\n"), DESK).tests[1].rationale
    assert "is not right" in told
    assert named in told if named else told.endswith("is not right.")


@pytest.mark.parametrize(
    ("nodes", "told"),
    [
        ("/one", "1 is missing"),
        ("/three", "/three should not be there and 2 are missing"),
        ("[/one, /two, /three]", "/three should not be there."),
        ("[/one, /two, /one]", "twice"),
    ],
)
def test_of_a_list_it_is_told_what_does_not_belong_and_how_much_is_missing(
    folder: Path, nodes: str, told: str
) -> None:
    (folder / "secret.yaml").write_text(KEYS)
    work = handed_in(f"topic: cmd_vel\nrate: 10\nnodes: {nodes}\n")
    assert told in grade(read_assignment(folder), work, DESK).tests[1].rationale


def test_a_choice_may_be_written_with_or_without_the_slash_in_front(folder: Path) -> None:
    for written in ("/cmd_vel", "cmd_vel", "/CMD_VEL"):
        assert grade(read_assignment(folder), handed_in(f"topic: {written}\n"), DESK).tests[0].points == 1.0


@pytest.mark.parametrize("written", ["ROS 2", "ros 2", "ROS2", "ros2"])
def test_a_choice_may_be_written_without_its_blanks(folder: Path, written: str) -> None:
    sheet = ASSIGNMENT_TEXT.replace("choices: [cmd_vel, odom, scan]", "choices: [ROS 2, Flatland]")
    (folder / "assignment.yaml").write_text(sheet)
    (folder / "secret.yaml").write_text(
        KEYS.replace(
            "{right: [cmd_vel], feedback: {odom: That one comes from the robot.}}", "{right: [ROS 2]}"
        )
    )
    assert grade(read_assignment(folder), handed_in(f"topic: {written}\n"), DESK).tests[0].points == 1.0


@pytest.mark.parametrize(
    "text",
    [
        "topic: [",
        "topik: odom\n",
        "- 1\n",
        f"rate: {'x' * 300}\n",
        "topic: !!python/object:os.system {}\n",
    ],
    ids=["broken", "key", "list", "long", "tag"],
)
def test_a_file_that_cannot_be_read_is_an_error_with_its_place(folder: Path, text: str) -> None:
    result = grade(read_assignment(folder), handed_in(text), DESK)
    assert {test.status for test in result.tests} == {CriterionStatus.STUDENT_ERROR}
    assert "answers.yaml" in result.tests[0].rationale
    assert "/tmp" not in result.tests[0].rationale


def test_without_the_secret_nothing_is_judged(folder: Path) -> None:
    result = grade(read_assignment(folder), handed_in("topic: cmd_vel\n"), GradingOptions(Level.LIMITED))
    assert {test.status for test in result.tests} == {CriterionStatus.SKIPPED}
    assert result.verdict is GradingVerdict.FAIL


def test_a_key_must_be_one_of_the_choices(folder: Path) -> None:
    (folder / "secret.yaml").write_text(KEYS.replace("[cmd_vel]", "[cmd]"))
    with pytest.raises(WorldError, match="none of the choices"):
        read_assignment(folder)


HOSTILE = {
    "a key twice": "rate: 10\nrate: 11\n",
    "a huge key": "? " + "k" * 90_000 + "\n: 3\n",
    "a list as a key": "? [1, 2]\n: 3\n",
    "a merge of nothing": "<<: 1\n",
    "a merge": "a: &a {rate: 10}\n<<: [*a, *a]\n",
    "a date": "rate: 9999-99-99\n2001-01-01: 1\n",
    "base 60": "rate: 190:20:30\n1:2:3: 1\n",
    "a number of 60,000 digits": "rate: 0b" + "1" * 60_000 + "\n",
    "a number of 6,000 digits": "rate: " + "9" * 6_000 + "\n",
    "a number beyond all": "rate: 1e999999999\n",
    "bytes": "rate: !!binary aGFsbG8=\n",
    "a set": "nodes: !!set {a, b}\n",
    "two documents": "---\nrate: 10\n---\nrate: 11\n",
    "half a surrogate": 'rate: "\\ud800"\n',
    "an escape": "rate: \x1b[31m\n",
    "no end": "rate: [" * 2_000 + "\n",
}


@every_case("name", HOSTILE)
def test_whatever_a_file_of_answers_holds_it_is_told(name: str, folder: Path) -> None:
    result = grade(read_assignment(folder), handed_in(HOSTILE[name]), DESK)
    assert (result.verdict, result.points) == (GradingVerdict.FAIL, 0.0)
    assert all(test.rationale.isprintable() or "\n" in test.rationale for test in result.tests)
    assert any("answers.yaml:" in test.rationale or test.rationale for test in result.tests)


def test_of_one_question_only_its_own_feedback_is_told_and_of_several_the_count(folder: Path) -> None:
    one, several = grade(read_assignment(folder), handed_in("topic: odom\nrate: 10\n"), DESK).tests
    assert one.rationale.startswith('"topic": odom is not right.')
    assert several.rationale.startswith('1 of 3 answers are right. "topic"')
    assert "%" not in one.rationale + one.actual + several.rationale + several.actual
