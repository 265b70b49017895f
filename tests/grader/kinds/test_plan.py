"""A layer plan made by hand: what it brings about, how many layers it has, and whether its proof is one."""

from __future__ import annotations

from pathlib import Path

import pytest

from grader.grading import GradingOptions, grade
from grader.reading import read_assignment
from grader.submission import Submission
from kit.host.sandbox.sandbox_config import Level
from kit.results.grading_result import CriterionStatus, GradingResult
from kit.world.problems import WorldError

ASSIGNMENT_TEXT = """
title: A hangar
kind: plan
submit: plan.yaml
level: 0
checks:
  - {check: complete, points: 1}
  - {check: nothing_more, points: 1}
  - {check: few_layers, id: few, points: 1, share: {none: 3, full: 2}}
  - {check: proof, points: 1, share: {none: 1, full: 2}}
"""
CASE = """
maps: [walls]
models: [robot, drone]
collide: {walls: [robot, drone]}
lasers: {lidar: [walls, drone]}
"""
GOOD = """
layers: {floor: [robot, walls], air: [drone, walls]}
lasers: {lidar: [air]}
proof: [robot - walls, walls - drone]
"""
DESK = GradingOptions(Level.LIMITED, secret=True)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    made = tmp_path / "hangar"
    made.mkdir()
    (made / "assignment.yaml").write_text(ASSIGNMENT_TEXT)
    (made / "secret.yaml").write_text("case: hangar.layers.yaml\n")
    (made / "hangar.layers.yaml").write_text(CASE)
    return made


def graded(folder: Path, text: str) -> GradingResult:
    return grade(read_assignment(folder), Submission("ada", "plan.yaml", {"plan.yaml": text.encode()}), DESK)


@pytest.mark.parametrize(
    ("text", "lost"),
    [
        (GOOD, ""),
        (GOOD.replace("proof: [robot - walls, walls - drone]", "proof: [robot - walls, lidar sees drone]"), ""),
        (GOOD.replace("[air]", "[]"), "complete"),
        (GOOD.replace("lidar: [air]", "lidar: [air, floor]"), "nothing_more"),
        (GOOD.replace("air: [drone, walls]", "air: [drone, walls], eye: [walls]"), "few"),
        (GOOD.replace("robot - walls", "lidar sees walls"), "proof"),
        (GOOD.replace("[robot - walls, walls - drone]", "[robot - walls, walls - robot]"), "proof"),
        ("layers: {all: [robot, drone, walls]}\nlasers: {lidar: [all]}\nproof: []\n", "nothing_more proof"),
        ("{}", "complete proof"),
        ("layers:\nlasers:\nproof:\n", "complete proof"),
        ("layers:\n  floor:\nlasers:\n  lidar:\n", "complete proof"),
    ],
    ids=["good", "another proof", "blind", "sees itself", "too many", "fits", "twice", "all in one", "nothing", "blank", "blank lists"],
)  # fmt: skip
def test_what_is_lost(folder: Path, text: str, lost: str) -> None:
    result = graded(folder, text)
    assert [test.id for test in result.tests if test.status is not CriterionStatus.PASS] == lost.split()
    assert all(not test.status.value.endswith("error") for test in result.tests)


def test_what_is_wrong_is_named(folder: Path) -> None:
    said = graded(folder, GOOD.replace("lidar: [air]", "lidar: [floor]")).tests
    assert "lidar must see drone" in said[0].rationale
    assert "lidar must not see robot, but does (layer floor)" in said[1].rationale


def test_a_proof_that_proves_nothing_is_told_why(folder: Path) -> None:
    said = graded(folder, GOOD.replace("robot - walls", "lidar sees walls")).tests[-1].rationale
    assert "One layer could serve both “lidar sees walls” and “walls - drone”" in said


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("layers: [", "plan.yaml"),
        ("layers: {a: [robbot]}", 'did you mean "robot"'),
        ("layers: {a: [robot]}\nlasers: {lida: [a]}", 'did you mean "lidar"'),
        ("layers: {a: [robot]}\nlasers: {lidar: [b]}", "layer of yours"),
        ("layer: {}", "layers"),
        ("layers: {" + ", ".join(f"l{n}: [robot]" for n in range(100)) + "}", "at most"),
        ("layers: !!python/object:os.system {}", "plan.yaml"),
    ],
)
def test_a_plan_that_cannot_be_read_is_an_error_with_its_place(folder: Path, text: str, word: str) -> None:
    tests = graded(folder, text).tests
    assert {test.status for test in tests} == {CriterionStatus.STUDENT_ERROR}
    assert word in tests[0].rationale
    assert "/tmp" not in tests[0].rationale


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("robot - wals", 'did you mean "walls"'),
        ("lida sees drone", 'did you mean "lidar"'),
        ("robot", "is no pair"),
        ("robot - drone", "is not among what must happen"),
        ("robot: walls", "write “robot - walls”"),
        ("lidar: walls", "write “lidar sees walls”"),
        ("[robot, walls]", "is no pair"),
        ("3", "is no pair"),
        ("~", "is no pair"),
    ],
)
def test_a_line_that_proves_nothing_is_named_and_costs_the_proof_alone(
    folder: Path, line: str, told: str
) -> None:
    lines = f"\n  - robot - walls\n  - {line}"
    *others, proof = graded(folder, GOOD.replace("[robot - walls, walls - drone]", lines)).tests
    assert all(test.is_passed for test in others)
    assert proof.status is CriterionStatus.FAIL
    number = GOOD[: GOOD.index("proof")].count("\n") + 3
    assert f"plan.yaml:{number}:5: " in proof.rationale
    assert told in proof.rationale


def test_a_proof_that_is_no_list_costs_the_proof_alone(folder: Path) -> None:
    *others, proof = graded(folder, GOOD.replace("[robot - walls, walls - drone]", "robot - walls")).tests
    assert all(test.is_passed for test in others)
    assert "write a list" in proof.rationale


def test_an_example_of_the_kit_can_be_the_case(folder: Path) -> None:
    (folder / "secret.yaml").write_text("case: drone\n")
    assert read_assignment(folder).task.names


def test_a_case_that_is_not_there_is_the_teachers_mistake(folder: Path) -> None:
    (folder / "secret.yaml").write_text("case: hangr.layers.yaml\n")
    with pytest.raises(WorldError, match="no case"):
        read_assignment(folder)
