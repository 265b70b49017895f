"""Environments that do nothing and forge what their process says: nothing counts that the world has not seen."""

from __future__ import annotations

from pathlib import Path

import pytest

from grader.grading import GradingOptions, grade
from grader.reading import read_assignment
from grader.submission import Submission
from kit.host.sandbox.sandbox_config import Level
from kit.results.grading_result import CriterionStatus, GradingResult, GradingVerdict
from tests.grader.conftest import LOCKS

LESSON = Path(__file__).parents[4] / "lessons" / "10-words-of-learning" / "hallway"

EMPTY = """
import gymnasium

class HallwayEnv(gymnasium.Env):
    def __init__(self):
        pass

    def step(self, action):
        return None
"""
"""An honest environment in which nothing is written yet."""

PATCHED_CHECKER = """
import sys
import gymnasium
import gymnasium.utils.env_checker

gymnasium.utils.env_checker.check_env = lambda *_, **__: None
gymnasium.spaces.Box.contains = gymnasium.spaces.Discrete.contains = lambda *_: True
examiner = sys.modules["__main__"]
for name in ("is_in_space", "is_observation_valid", "run_checker", "first_checker_complaint"):
    setattr(examiner, name, lambda *_, **__: "")
"""

FORGED_CALLS = """
import sys
import gymnasium

examiner = sys.modules["__main__"]
calls = []

def number(kind, value):
    return {"kind": kind, "value": value}

def forge(question):
    calls.append(question["call"])
    seen = {"kind": "ndarray", "dtype": "float32", "shape": [9], "numbers": [1.0] * 9}
    info = {"kind": "dict", "items": {}}
    if question["call"] == "reset":
        calls.clear()
        parts = [seen, info]
    else:
        over = len(calls) >= 200
        parts = [seen, number("float", 1.0), number("bool", False), number("bool", over), info]
    returned = {"kind": "tuple", "count": len(parts), "parts": parts}
    return {"returned": returned, "inside": True, "says": "", "warns": [], "generator": "0", "reused": [False, False]}

for name, value in list(vars(examiner).items()):
    if name in ("reset", "step", "run_checker"):
        setattr(examiner, name, lambda env, question: forge(question))
    if name == "CallRunner":
        value.answer = lambda self, question: forge(question)
"""
"""Row 9 of the catalogue: the functions of the program that calls the environment are replaced."""

FORGED_SPACES = """
import itertools
examiner.describe_space = lambda value: next(spaces)
spaces = itertools.cycle((
    {"kind": "Discrete", "n": 3, "start": 0},
    {"kind": "Box", "shape": [9], "dtype": "float32", "low": 0.0, "high": 2.0, "lows": [0.0] * 9, "highs": [2.0] * 9},
))
"""

FORGED_NUMBERS = {
    "a number that does not fit its kind": '{"kind": "int8", "value": 1e300}',
    "an array of seventy dimensions": '{"kind": "ndarray", "dtype": "float32", "shape": [1] * 70, "numbers": [1.0]}',
}
"""Descriptions of values that no numpy can make again."""

ANSWERS_IN_ADVANCE = """
import json
import rclpy
import sys
from std_msgs.msg import String

examiner = sys.modules["__main__"]
answer = examiner.CallRunner.answer

def answer_twice(self, question):
    node = rclpy.create_node("helper")
    publisher = node.create_publisher(String, "/examination/answer", 10)
    publisher.publish(String(data=json.dumps({**forge(question), "number": question["number"]})))
    return forge(question)

examiner.CallRunner.answer = answer_twice
"""


def graded(source: str, level: Level = Level.LIMITED) -> GradingResult:
    submission = Submission("ada", "hallway_env.py", {"hallway_env.py": source.encode()})
    return grade(read_assignment(LESSON), submission, GradingOptions(level))


@pytest.fixture(scope="module")
def empty() -> GradingResult:
    return graded(EMPTY)


def points(result: GradingResult) -> dict[str, float]:
    return {test.id: test.points for test in result.tests if test.points}


@pytest.mark.long
@pytest.mark.parametrize(
    "level", [Level.LIMITED, pytest.param(Level.FILTERED, marks=LOCKS)], ids=["level 0", "level 1"]
)
@pytest.mark.parametrize("forgery", [PATCHED_CHECKER, FORGED_CALLS], ids=["checker", "calls"])
def test_a_forged_examination_earns_what_an_empty_environment_earns(
    forgery: str, level: Level, empty: GradingResult
) -> None:
    assert points(empty) == {}
    result = graded(forgery + EMPTY, level)
    assert points(result) == {}
    assert result.verdict is not GradingVerdict.BROKEN


@pytest.mark.long
def test_forged_spaces_earn_what_spaces_of_an_empty_environment_earn() -> None:
    """Nothing: that the spaces are right counts once the world has seen the robot act on them."""
    declared = EMPTY.replace(
        "        pass\n",
        "        self.action_space = gymnasium.spaces.Discrete(3)\n"
        "        self.observation_space = gymnasium.spaces.Box(0.0, 2.0, (9,))\n",
    )
    result = graded(FORGED_CALLS + FORGED_SPACES + EMPTY)
    honest = graded(declared)
    assert points(result) == points(honest) == {}
    assert "action_space is right, and counts" in {test.id: test.rationale for test in honest.tests}["spaces"]
    assert any("before time had passed in the world" in test.rationale for test in result.tests)


@pytest.mark.long
def test_a_second_answer_to_one_question_ends_the_examination() -> None:
    result = graded(FORGED_CALLS + ANSWERS_IN_ADVANCE + EMPTY)
    assert points(result) == {}
    assert result.tests[0].status is CriterionStatus.PROTOCOL_ERROR


@pytest.mark.long
@pytest.mark.parametrize("name", FORGED_NUMBERS)
def test_a_value_that_cannot_be_made_again_is_no_fault_of_the_graders(name: str) -> None:
    forged = FORGED_CALLS.replace("parts = [seen, info]", f"parts = [{FORGED_NUMBERS[name]}, info]")
    result = graded(forged + EMPTY)
    assert points(result) == {}
    assert result.verdict is GradingVerdict.FAIL
