"""Requirements files: read, refused at the right place, and written."""

from __future__ import annotations

import random
from dataclasses import replace
from pathlib import Path

import pytest

from kit.layers.examples import EXAMPLES
from kit.layers.requirements import ContactRequirement, LayerEntity, SightRequirement
from kit.layers.requirements_file import is_world_file, read_requirements, requirements_text
from kit.world.problems import WorldError
from tests.layers.cases import random_case

WHOLE = """\
title: A yard
maps: [hall, yard]
models: [robot, crane, chair]
parts: {crane: [hook, base]}
bodies: {crane.base: [base, wheel.0]}
copies: {chair: [chair1, chair2]}
ghosts: [crane.hook]
collide:
  robot: [hall, crane.base, chair]
  chair: [chair]
either: {chair: [hall]}
apart: {robot: [yard]}
lasers: {robot.front: [hall, chair]}
may_see: {robot.front: [crane]}
blind: {robot.front: [yard]}
"""


def file(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "yard.layers.yaml"
    path.write_text(text)
    return path


def test_everything_a_file_can_say(tmp_path: Path) -> None:
    asked = read_requirements(file(tmp_path, WHOLE))
    case = asked.case
    assert case.title == "A yard"
    assert case.entities == (
        LayerEntity("hall", "map"),
        LayerEntity("yard", "map"),
        LayerEntity("robot", model="robot"),
        LayerEntity("crane.hook", model="crane", is_ghost=True),
        LayerEntity("crane.base", model="crane"),
        LayerEntity("chair", model="chair", copies=2),
    )
    assert case.collide == (
        ContactRequirement("robot", "hall"),
        ContactRequirement("robot", "crane.base"),
        ContactRequirement("robot", "chair"),
        ContactRequirement("chair", "chair"),
    )
    assert case.either == {ContactRequirement("chair", "hall")}
    assert case.laser["robot.front"].sees == {"hall", "chair"}
    assert case.laser["robot.front"].either == {"crane.hook", "crane.base"}
    assert asked.copies == {"robot": ("robot",), "crane": ("crane",), "chair": ("chair1", "chair2")}
    assert asked.bodies == {"crane.base": ("base", "wheel.0")}
    assert asked.world is None
    assert asked.locations[ContactRequirement("hall", "robot")].line == 9
    assert asked.locations[SightRequirement("robot.front", "hall")].line == 13


def test_a_models_name_stands_for_all_its_parts(tmp_path: Path) -> None:
    text = "models: [robot, crane]\nparts: {crane: [hook, base]}\ncollide: {robot: [crane], crane: [crane]}\n"
    assert read_requirements(file(tmp_path, text)).case.collide == (
        ContactRequirement("robot", "crane.hook"),
        ContactRequirement("robot", "crane.base"),
        ContactRequirement("crane.hook", "crane.base"),
    )


def test_the_world_is_named_relative_to_the_file(tmp_path: Path) -> None:
    assert (
        read_requirements(file(tmp_path, "world: sub/my.world.yaml\n")).world
        == tmp_path / "sub/my.world.yaml"
    )


@pytest.mark.parametrize(
    ("text", "places"),
    [
        ("maps: [a]\nmodels: [robot]\ncollide: {robot: [a, robto]}\n", {3: 'did you mean "robot"'}),
        ("maps: [a]\nmodels: [robot]\ncollide: {robto: [a]}\n", {3: 'did you mean "robot"'}),
        ("maps: [hall, yard]\ncollide:\n  hall: [yard]\n", {3: "maps never collide"}),
        ("maps: [hall]\ncollide: {hall: [hall]}\n", {2: "itself"}),
        ("models: [a, b]\ncollide: {a: [b]}\napart: {b: [a]}\n", {3: "line 2"}),
        ("models: [a, b]\ncollide: {a: [b]}\neither: {b: [a]}\n", {3: "line 2"}),
        ("models: [a, b]\nlasers: {l: [a]}\nblind: {l: [a]}\n", {3: "line 2"}),
        ("models: [a, b]\nlasers: {l: [a]}\nmay_see: {l: [b, a]}\n", {3: "line 2"}),
        ("models: [a, b]\nlasers: {front: [a]}\nblind: {frnt: [b]}\n", {3: 'did you mean "front"'}),
        ("models: [a, lamp]\nghosts: [lamp]\ncollide: {a: [lamp]}\n", {3: "ghost"}),
        ("models: [lot, a]\ncopies: {lot: [x, y]}\ncollide: {a: [lot]}\n", {1: "copies of lot"}),
        ("models: [a]\ncopies: {b: [x]}\n", {2: "no model"}),
        ("models: [a]\nparts: {b: [x]}\n", {2: "no model"}),
        ("models: [a]\nbodies: {b: [x]}\n", {2: "no part"}),
        ("models: [a, a]\n", {1: "twice"}),
        ("maps: [a]\nmodels: [a]\n", {2: "twice"}),
        ("models: [a]\ncolide: {}\n", {2: 'did you mean "collide"'}),
        ("models: [a]\ncollide: [a]\n", {2: "mapping"}),
        ("models: a\n", {1: "list"}),
        ("models: [a, [b]]\n", {1: "text"}),
        ("models: [a]\nmodels: [b]\n", {2: "twice"}),
        ("- a\n", {1: "mapping"}),
        ("", {1: "empty"}),
        ("models: [a\n", {1: "YAML"}),
        ("models: [a, b]\ncollide: {a: [c], c: [b]}\nlasers: {l: [d]}\n", {2: '"c"', 3: '"d"'}),
    ],
)
def test_every_mistake_is_named_at_its_place(tmp_path: Path, text: str, places: dict[int, str]) -> None:
    path = file(tmp_path, text)
    with pytest.raises(WorldError) as caught:
        read_requirements(path)
    problems = caught.value.problems
    for line, words in places.items():
        assert any(
            p.location.line == line and p.location.file == path and words in p.message for p in problems
        ), problems
    assert {p.location.line for p in problems} == places.keys()


@pytest.mark.parametrize("name", ["missing.yaml", ".", "no/such/folder.yaml", "nul\0.yaml"])
def test_what_cannot_be_read_says_why(tmp_path: Path, name: str) -> None:
    for read in (read_requirements, is_world_file):
        with pytest.raises(WorldError):
            read(tmp_path / name)


def test_a_contradiction_names_both_lines_and_the_smallest_pair(tmp_path: Path) -> None:
    text = "models: [a, b, c, d]\ncollide:\n  a: [b, c, d]\n  b: [c, d]\napart:\n  c: [d]\n  d: [b]\n"
    with pytest.raises(WorldError) as caught:
        read_requirements(file(tmp_path, text))
    (problem,) = caught.value.problems
    assert problem.location.line == 7
    assert "d - b" in problem.message
    assert "line 4" in problem.message


@pytest.mark.parametrize("name", EXAMPLES)
def test_an_example_is_read_as_it_was_written(tmp_path: Path, name: str) -> None:
    path = file(tmp_path, requirements_text(EXAMPLES[name]))
    assert read_requirements(path).case == EXAMPLES[name]
    assert not is_world_file(path)


@pytest.mark.parametrize("seed", range(20))
def test_any_case_comes_back(tmp_path: Path, seed: int) -> None:
    """But for the order of its pairs, which lists by the first name cannot always keep."""
    case = random_case(random.Random(seed), 7, 2, 0.5)
    things = sorted(case.entities, key=lambda e: e.kind == "bodies")  # maps come first in a file
    entities = tuple(replace(e, model=e.name if e.kind == "bodies" else "", copies=1) for e in things)
    case = replace(case, entities=entities)
    back = read_requirements(file(tmp_path, requirements_text(case))).case
    assert set(back.collide) == set(case.collide)
    assert replace(back, collide=case.collide) == case


@pytest.mark.parametrize(
    "name", ["yes", "12", "a: b", "a#b", '"', "-", "ä", "a\\b", "null", "[x]", "*a", " a"]
)
def test_odd_names_survive_writing(tmp_path: Path, name: str) -> None:
    case = replace(
        EXAMPLES["two"],
        entities=(LayerEntity("w", "map"), LayerEntity(name, model=name)),
        collide=(ContactRequirement(name, "w"),),
    )
    assert read_requirements(file(tmp_path, requirements_text(case))).case == case


@pytest.mark.parametrize(
    ("text", "world"),
    [
        ("properties: {}\nlayers: []\n", True),
        ("layers: []\n", True),
        ("properties: {}\nlayers: []\nmodels: []\nplugins: []\n", True),
        ("models: [a]\ncollide: {}\n", False),
        ("world: w.yaml\n", False),
        ("models: [a]\n", False),
    ],
)
def test_a_world_is_told_from_requirements_by_its_keys(tmp_path: Path, text: str, world: bool) -> None:
    assert is_world_file(file(tmp_path, text)) == world
