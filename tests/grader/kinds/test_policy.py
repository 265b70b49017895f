"""Policies that are handed in: good ones, ones of another task, and files that only look like one."""

from __future__ import annotations

import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from grader.grading import GradingOptions, grade
from grader.reading import read_assignment
from grader.submission import Submission
from kit.host.sandbox.sandbox_config import Level
from kit.learning.policies.policy import Policy, task_interface
from kit.learning.policies.policy_file import policy_bytes
from kit.learning.tasks.task_spec import TaskSpec
from kit.results.grading_result import GradingResult, GradingVerdict
from kit.world.problems import WorldError
from tests.grader.packed import array_bytes, zipped
from tests.learning.policies.test_evaluation import always

ASSIGNMENT_TEXT = """
title: Straight ahead
kind: policy
submit: best.npz
level: 0
policy: {task: ahead.yaml, episodes: 40}
checks:
  - {check: succeeds, points: 2}
  - {check: every_case, points: 1}
  - {check: collisions, points: 1}
"""
TASK = """\
summary: Straight ahead
maps: [hall_straight]
actions: {twists: {back: [-0.3, 0], forward: [0.3, 0]}}
observation: {sectors: 5}
reward: {name: algorithm-1}
goal: {kind: target}
target: {radius: 0.3}
start: {shifted: false}
"""
OPTIONS = GradingOptions(Level.LIMITED)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    made = tmp_path / "ahead"
    made.mkdir()
    (made / "assignment.yaml").write_text(ASSIGNMENT_TEXT)
    (made / "ahead.yaml").write_text(TASK)
    return made


def policy(folder: Path, action: int) -> Policy:
    choice = TaskSpec(str(folder / "ahead.yaml")).frozen()
    return replace(always(choice, action), interface=task_interface(choice.resolve()))


def graded(folder: Path, data: bytes, options: GradingOptions = OPTIONS) -> GradingResult:
    return grade(read_assignment(folder), Submission("ada", "best.npz", {"best.npz": data}), options)


def points(result: GradingResult) -> dict[str, float]:
    return {test.id: test.points for test in result.tests}


def test_a_policy_is_judged_by_what_it_reaches(folder: Path) -> None:
    good = points(graded(folder, policy_bytes(policy(folder, 1))))
    assert good["collisions"] == 1
    assert good["succeeds"] > 1.5
    bad = graded(folder, policy_bytes(policy(folder, 0)))
    assert set(points(bad).values()) == {0}
    assert any("straight" in test.rationale for test in bad.tests)


def test_secret_episodes_are_others(folder: Path) -> None:
    (folder / "secret.yaml").write_text("seed: 987654321987654321\n")
    data = policy_bytes(policy(folder, 1))
    result = graded(folder, data, replace(OPTIONS, secret=True))
    assert points(result)["succeeds"] == 2
    assert "987654321987654321" not in str(result)


@pytest.mark.parametrize(
    "kind", ["another task", "changed since", "text", "half", "bomb", "pickle", "claims"]
)
def test_what_is_no_policy_for_this_says_why_and_costs_its_own_points(folder: Path, kind: str) -> None:
    whole, word = policy_bytes(policy(folder, 1)), "damaged"
    match kind:
        case "another task":
            data, word = policy_bytes(always(TaskSpec("turn"), 1)), "trained on turn"
        case "changed since":
            data, word = whole, "scale"
            (folder / "ahead.yaml").write_text(TASK.replace("sectors: 5", "sectors: 5, scale: 0.5"))
        case "text":
            data = b"no archive"
        case "half":
            data = whole[: len(whole) // 2]
        case "bomb":
            data, word = zipped({"about.npy": array_bytes(np.zeros(1 << 20))}), "larger than 2 MiB"
        case "pickle":
            buffer = io.BytesIO()
            np.save(buffer, np.array([{}], dtype=object), allow_pickle=True)
            data, word = zipped({"about.npy": buffer.getvalue()}), "not what it says"
        case _:
            header = array_bytes(np.zeros(4))[:128].replace(b"(4,), ", b"(9999999999,),")
            data, word = zipped({"about.npy": header}), "not what it says"
    result = graded(folder, data)
    assert result.verdict is GradingVerdict.FAIL
    assert any(word in test.rationale for test in result.tests), [test.rationale for test in result.tests]


def test_a_teachers_mistake_is_told_when_read(folder: Path) -> None:
    for old, new, word in (
        ("ahead.yaml", "none.yaml", "nor a file"),
        ("episodes: 40", "episodes: 5", "episodes"),
    ):
        (folder / "assignment.yaml").write_text(ASSIGNMENT_TEXT.replace(old, new))
        with pytest.raises(WorldError, match=word):
            read_assignment(folder)
