"""A requirements file and a world: what is asked of it, what does not fit, and where it cannot be had."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.layers.assignment import RequirementBreach
from kit.layers.flatland.layer_lists import find_layer_lists, read_world_layers
from kit.layers.flatland.requirement_binding import bind_requirements
from kit.layers.flatland.world_case import WorldCase
from kit.layers.planning import solve_layers
from kit.layers.requirements import ContactRequirement, SightRequirement
from kit.layers.requirements_file import read_requirements
from kit.world.problems import WorldError
from tests.layers.conftest import YARD, WriteFiles

ASKED = """\
maps: [solid, fence]
models: [robot, chair, beacon]
copies: {chair: [chair1, chair2]}
collide:
  solid: [robot, chair]
  fence: [chair]
  robot: [chair]
  chair: [chair]
lasers:
  robot.lidar: [solid]
  eye: [robot]
"""


def laid(world: Path, text: str) -> WorldCase:
    asked = world.with_name("asked.yaml")
    asked.write_text(text)
    return bind_requirements(read_requirements(asked), find_layer_lists(read_world_layers(world)))


def test_what_the_yard_does_is_what_is_asked(yard: Path) -> None:
    bound = laid(yard, ASKED)
    assert bound.current_breaches == ()
    assert solve_layers(bound.case).size == 4
    assert set(bound.lasers) == {"robot.lidar", "beacon.eye"}


@pytest.mark.parametrize(
    ("old", "new", "breach"),
    [
        (
            "solid: [robot, chair]",
            "solid: [chair]",
            RequirementBreach(ContactRequirement("solid", "robot"), False, ("solid", "both")),
        ),
        (
            "fence: [chair]",
            "fence: [chair, robot]",
            RequirementBreach(ContactRequirement("fence", "robot"), True),
        ),
        (
            "eye: [robot]",
            "eye: [robot, chair]",
            RequirementBreach(SightRequirement("beacon.eye", "chair"), True),
        ),
        (
            "lidar: [solid]",
            "lidar: []",
            RequirementBreach(SightRequirement("robot.lidar", "solid"), False, ("seen",)),
        ),
    ],
)
def test_where_the_world_differs_from_what_is_asked(
    yard: Path, old: str, new: str, breach: RequirementBreach
) -> None:
    assert laid(yard, ASKED.replace(old, new)).current_breaches == (breach,)


def test_one_list_of_several_that_does_not_is_found(write: WriteFiles) -> None:
    """The base is right; the bumper, which the base does not make up for, is in no layer."""
    robot = YARD["robot.model.yaml"].replace("layers: [solid, both, tracked]}  # in front", "layers: []}")
    wrong = laid(write({"robot.model.yaml": robot}), ASKED).current_breaches
    assert {breach.requirement for breach in wrong if breach.is_missing} == {
        ContactRequirement("solid", "robot"),
        ContactRequirement("robot", "chair"),
        SightRequirement("beacon.eye", "robot"),
    }


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("maps: [solid, fence]", "maps: [solid, fence, moat]", 'no map called "moat"'),
        ("maps: [solid, fence]", "maps: [solid, seen, fence]", "names of one map"),
        ("models: [robot, chair, beacon]", "models: [robot, chair, beacon, cat]", 'no model "cat"'),
        ("models: [robot, chair, beacon]", "models: [robot, chair]", '"beacon" is not in the requirements'),
        ("copies: {chair: [chair1, chair2]}", "copies: {chair: [chair1, chair3]}", 'did you mean "chair'),
        ("copies: {chair: [chair1, chair2]}", "copies: {chair: [chair1]}", '"chair2" is not in'),
        ("  eye: [robot]\n", "", "robot.lidar is not in|beacon.eye is not in"),
        ("  eye: [robot]", "  eye: [robot]\n  ear: [solid]", 'no laser "ear"'),
        (
            "models: [robot, chair, beacon]",
            "models: [robot, chair, beacon]\nparts: {robot: [base]}",
            "bumper",
        ),
        (
            "models: [robot, chair, beacon]",
            "models: [robot, chair, beacon]\nparts: {robot: [base, bumpr]}",
            'no body "bumpr": did you mean "bumper"',
        ),
        ("fence: [chair]", "fence: [chair, beacon]", "can never collide.*neither is dynamic"),
    ],
)
def test_requirements_that_do_not_fit_the_world_say_why(yard: Path, old: str, new: str, words: str) -> None:
    assert old in ASKED
    with pytest.raises(WorldError, match=words):
        laid(yard, ASKED.replace(old, new))


def test_a_collision_that_can_never_happen_is_named_in_its_line(yard: Path) -> None:
    with pytest.raises(WorldError) as caught:
        laid(yard, ASKED.replace("fence: [chair]", "fence: [chair, beacon]"))
    assert [problem.location.line for problem in caught.value.problems] == [6]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("robot: [chair1]", "chair1.*chair2|chair2.*chair1"),
        ("chair1: [chair2, robot]", "chair1.*chair2|chair2.*chair1"),
    ],
)
def test_one_list_cannot_serve_two_instances_with_different_needs(yard: Path, text: str, words: str) -> None:
    """Both chairs are read from one file, and only one of them is to meet the robot."""
    asked = f"maps: [solid, fence]\nmodels: [robot, chair1, chair2, beacon]\ncollide:\n  {text}\n"
    with pytest.raises(WorldError, match=words) as caught:
        laid(yard, asked + "lasers: {robot.lidar: [], beacon.eye: []}\n")
    (problem,) = caught.value.problems
    assert problem.location.file.name == "chair.model.yaml"
    assert "file of its own" in problem.message


def test_parts_can_be_single_footprints(write: WriteFiles) -> None:
    chair = """\
bodies:
  - name: seat
    footprints:
      - {type: circle, radius: 0.2, density: 1, layers: [both, fence]}
      - {type: circle, radius: 0.1, density: 1, layers: [both]}
"""
    asked = ASKED.replace(
        "copies:",
        "parts: {chair: [wide, narrow]}\nbodies: {chair.wide: [seat.0], chair.narrow: [seat.1]}\ncopies:",
    )
    asked = asked.replace("fence: [chair]", "fence: [chair.wide]")
    bound = laid(write({"chair.model.yaml": chair}), asked)
    assert bound.current_breaches == ()
    assert {"chair.seat.0", "chair.seat.1"} <= set(bound.case.names)
