"""Getters check, note what is wrong at its place, and return a value of the right type all the same."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from kit.geometry import Pose
from kit.world.documents import AllowedRoot, WorldDocuments
from kit.world.problems import MAX_PROBLEMS, Problem, ProblemCollector, WorldError
from kit.world.records import SourceLocation
from kit.world.yaml_section import Section
from tests.cases import every_case


class Reading:
    """A section made from a text, and the problems it has noted."""

    def __init__(self, file: Path) -> None:
        self._problems = ProblemCollector()
        section = WorldDocuments(AllowedRoot.containing(file), {"SECRET": "hunter2"}, self._problems).section(
            file, SourceLocation(file)
        )
        assert section is not None
        self.section = section

    @property
    def problems(self) -> list[Problem]:
        try:
            self._problems.raise_if_any()
        except WorldError as error:
            return list(error.problems)
        return []

    @property
    def said(self) -> str:
        return "\n".join(problem.message for problem in self.problems)


@pytest.fixture
def read(tmp_path: Path) -> Callable[[str], Reading]:
    def read(text: str) -> Reading:
        file = tmp_path / "section.yaml"
        file.write_text(text, encoding="utf-8")
        return Reading(file)

    return read


Read = Callable[[str], Reading]
Get = Callable[[Section], Any]

GOOD: list[tuple[str, Get, object]] = [
    ("a: wall", lambda s: s.text("a"), "wall"),
    ("a: 12", lambda s: s.text("a"), "12"),
    ("a: no", lambda s: s.text("a"), "no"),
    ("a: '~'", lambda s: s.text("a"), "~"),
    ("b: 1", lambda s: s.text("a", "map"), "map"),
    ("a: x", lambda s: s.text("a", choices=["x", "y"]), "x"),
    ("a: big hall", lambda s: s.name("a"), "big hall"),
    ("a: 壁　廊", lambda s: s.name("a"), "壁　廊"),
    ("a: two", lambda s: s.choice("a", {"one": 1, "two": 2}), 2),
    ("b: 1", lambda s: s.choice("a", {"one": 1, "two": 2}, "one"), 1),
    ("a: 1e-3", lambda s: s.number("a"), 0.001),
    ("a: '1.5'", lambda s: s.number("a"), 1.5),
    ("a: .inf", lambda s: s.number("a", infinite=True), math.inf),
    ("b: 1", lambda s: s.number("a", math.inf), math.inf),
    ("a: 0", lambda s: s.number("a", minimum=0, maximum=0), 0.0),
    ("a: -7", lambda s: s.integer("a"), -7),
    ("a: 0x10", lambda s: s.integer("a"), 16),
    ("a: 007", lambda s: s.integer("a"), 7),
    ("a: 012", lambda s: s.text("a"), "012"),
    ("a: 1:30", lambda s: s.text("a"), "1:30"),
    ("a: 012.5", lambda s: s.number("a"), 12.5),
    ("a: yes", lambda s: s.flag("a"), True),
    ("a: false", lambda s: s.flag("a", True), False),
    ("a: [1, 2.5]", lambda s: s.numbers("a", length=2), (1.0, 2.5)),
    ("b: 1", lambda s: s.numbers("a", [0, 0, 0], length=3), (0.0, 0.0, 0.0)),
    ("a: [x, 1]", lambda s: s.texts("a"), ("x", "1")),
    ("b: 1", lambda s: s.texts("a", ("all",)), ("all",)),
    ("a: wall", lambda s: s.names("a"), ("wall",)),
    ("a: [wall, floor]", lambda s: s.names("a"), ("wall", "floor")),
    ("a: [1, 2, 3]", lambda s: s.pose("a"), Pose(1, 2, 3)),
    ("b: 1", lambda s: s.pose("a", Pose(1, 2, 3)), Pose(1, 2, 3)),
    ("a: [[0, 1], [2, 3]]", lambda s: s.points("a"), ((0.0, 1.0), (2.0, 3.0))),
    ("a: [-1, 2, 0.5, 1]", lambda s: s.color("a", (1, 1, 1, 1)), (0.0, 1.0, 0.5, 1.0)),
    ("a: {b: 1}", lambda s: s.section("a").integer("b"), 1),
    ("b: 1", lambda s: s.section("a", None), None),
    ("a: [{b: 1}, {b: 2}]", lambda s: [x.integer("b") for x in s.sections("a")], [1, 2]),
    ("b: 1", lambda s: s.sections("a", ()), ()),
    ("a: {b: [1, no, {c: ~}]}", lambda s: s.remaining_values(), {"a": {"b": (1, "no", {"c": None})}}),
    ("a: 1\nb: 2", lambda s: s.keys(), ("a", "b")),
]


@every_case(("text", "get", "value"), GOOD)
def test_a_right_value_is_read(read: Read, text: str, get: Get, value: object) -> None:
    reading = read(text)
    assert get(reading.section) == value
    assert reading.problems == []


BAD: list[tuple[str, Get, object, int, list[str]]] = [
    # text, getter, what it returns all the same, column of the problem, words of the message
    ("b: 1", lambda s: s.text("a"), "", 1, ["a", "missing"]),
    ("a: [x]", lambda s: s.text("a", "map"), "map", 4, ["a", "list"]),
    ("a:", lambda s: s.text("a"), "", 3, ["nothing"]),
    ("a: z", lambda s: s.text("a", choices=["x", "y"]), "x", 4, ["z", "x", "y"]),
    ("b: 1", lambda s: s.text("a", choices=["x", "y"]), "x", 1, ["a", "missing"]),
    ('a: "\\e[2J"', lambda s: s.text("a"), "", 4, ["control"]),
    ('a: "x\\ny"', lambda s: s.name("a"), "x\ny", 4, ["line"]),
    ("a: tow", lambda s: s.choice("a", {"one": 1, "two": 2}), None, 4, ["tow", "two"]),
    ("a: tow", lambda s: s.choice("a", {"one": 1, "two": 2}, "one"), 1, 4, ["tow", "two"]),
    ("a: fast", lambda s: s.number("a", 2.0), 2.0, 4, ["fast"]),
    ("a: {}", lambda s: s.number("a"), 0.0, 4, ["mapping"]),
    ("a: .nan", lambda s: s.number("a"), 0.0, 4, [".nan"]),
    ("a: .nan", lambda s: s.number("a", infinite=True), 0.0, 4, [".nan"]),
    ("a: .inf", lambda s: s.number("a"), 0.0, 4, [".inf"]),
    ("a: 1e13", lambda s: s.number("a"), 0.0, 4, ["1e13"]),
    ("a: 0", lambda s: s.number("a", above=0), 1.0, 4, ["greater than 0"]),
    ("a: 1e-320", lambda s: s.number("a", above=0), 1.0, 4, ["greater than 0", "1e-320"]),
    ("a: -1", lambda s: s.number("a", minimum=0), 0.0, 4, ["at least 0"]),
    ("a: 9", lambda s: s.number("a", maximum=8), 0.0, 4, ["at most 8"]),
    ("a: 9", lambda s: s.number("a", maximum=-8), -8.0, 4, ["at most -8"]),
    ("a: -.inf", lambda s: s.number("a", minimum=0, infinite=True), 0.0, 4, ["at least 0"]),
    ("a: 1.5", lambda s: s.integer("a"), 0, 4, ["whole", "1.5"]),
    ("a: 3000000000", lambda s: s.integer("a", 4), 4, 4, ["3000000000"]),
    ("a: 012", lambda s: s.integer("a", 4), 4, 4, ["12", "10", "'012'"]),
    ("a: -010", lambda s: s.number("a", 2.0), 2.0, 4, ["-10", "-8"]),
    ("a: '012'", lambda s: s.number("a", 2.0), 2.0, 4, ["two ways"]),
    ("a: 1_000", lambda s: s.number("a", 2.0), 2.0, 4, ["1000"]),
    ("a: 1:30", lambda s: s.number("a", 2.0), 2.0, 4, ["90"]),
    ("a: 0b11", lambda s: s.integer("a", 4), 4, 4, ["3"]),
    ("a: [1, 2, 010]", lambda s: s.numbers("a", length=3), (0.0, 0.0, 0.0), 11, ["10", "8"]),
    ("a: [1, 010]", lambda s: s.integers("a", minimum=0, maximum=99), (), 8, ["10", "8"]),
    ("a: {b: [1, 012]}", lambda s: s.remaining_values(), {"a": {"b": (1, 12)}}, 12, ["12", "10"]),
    ("a: maybe", lambda s: s.flag("a", True), True, 4, ["maybe", "true", "false"]),
    ("a: [1, 2]", lambda s: s.pose("a"), Pose(), 4, ["exactly 3", "2"]),
    ("a: [1, x, 2]", lambda s: s.numbers("a", length=3), (0.0, 0.0, 0.0), 8, ["[1]", "x"]),
    ("a: 1", lambda s: s.numbers("a", at_least=2), (0.0, 0.0), 4, ["list"]),
    ("a: [1, [2]]", lambda s: s.texts("a"), ("1",), 8, ["[1]", "list"]),
    ("a: []", lambda s: s.names("a"), (), 4, ["at least 1"]),
    ("a: [x, '']", lambda s: s.names("a"), ("x", ""), 4, ["name"]),
    ("a: [[0, 1], 2]", lambda s: s.points("a"), ((0.0, 1.0),), 13, ["[1]", "point"]),
    ("a: []", lambda s: s.section("a").integer("b"), 0, 4, ["mapping"]),
    ("b: 1", lambda s: s.section("a").section("b").pose("c"), Pose(), 1, ["a", "missing"]),
    ("a: [{b: 1}, 2]", lambda s: [x.integer("b") for x in s.sections("a")], [1, 0], 13, ["[1]", "mapping"]),
    ("a: [{}]", lambda s: len(s.sections("a", length=2)), 0, 4, ["exactly 2"]),
]


@every_case(("text", "get", "value", "column", "words"), BAD)
def test_a_wrong_value_is_noted_once_where_it_stands(
    read: Read, text: str, get: Get, value: object, column: int, words: list[str]
) -> None:
    reading = read(text)
    assert get(reading.section) == value
    (problem,) = reading.problems
    assert (problem.location.line, problem.location.column) == (1, column)
    assert all(word in problem.message for word in words), problem.message


def test_finish_notes_every_unknown_key_with_the_nearest_right_one(read: Read) -> None:
    reading = read("range: 5\nrnage: 4\ncolour: red\nxyz: 1\n")
    reading.section.number("range")
    reading.section.color("color", (1, 1, 1, 1))
    reading.section.has("layers")
    reading.section.finish()
    assert [problem.location.line for problem in reading.problems] == [2, 3, 4]
    assert "color" in reading.problems[1].message
    assert all(word in reading.problems[2].message for word in ("xyz", "color", "layers"))


def test_where_unknown_keys_are_no_mistake_one_like_a_missing_key_is_still_pointed_out(read: Read) -> None:
    reading = read("origins: [0, 0, 0]\nnegate: 0\n")
    reading.section.pose("origin")
    reading.section.finish(ignore_unknown=True)
    assert [(problem.location.line, "origin" in problem.message) for problem in reading.problems] == [
        (1, True),
        (1, True),
    ]
    fine = read("origin: [0, 0, 0]\norigins: 0\n")
    fine.section.pose("origin")
    fine.section.finish(ignore_unknown=True)
    assert fine.problems == []


def test_problems_of_ones_own_stand_at_the_key_or_at_the_section(read: Read) -> None:
    reading = read("a: 1\nb:   2\n")
    reading.section.error("one", "b")
    reading.section.error("two")
    reading.section.error("three", "missing")
    assert [(str(problem.location.line), problem.location.column) for problem in reading.problems] == [
        ("1", 1),
        ("1", 1),
        ("2", 6),
    ]


def test_the_value_of_a_variable_is_used_but_never_shown(read: Read) -> None:
    reading = read("a: env(SECRET)\nb: env(SECRET)\nc: [env(SECRET)]\nd: env(SECRET)\n")
    section = reading.section
    assert section.text("a") == "hunter2"
    section.number("b")
    section.numbers("c")
    section.text("d", choices=["x"])
    assert len(reading.problems) == 3
    assert "hunter2" not in reading.said
    assert "SECRET" in reading.said


def test_a_value_that_could_not_be_had_is_reported_once(read: Read) -> None:
    reading = read("a: $eval 1 + 1\nb: [$eval 1]\n")
    assert reading.section.number("a", 3.0) == 3.0
    assert reading.section.integer("a") == 0
    assert reading.section.names("a") == ("",)
    reading.section.numbers("b")
    reading.section.sections("b")
    assert [problem.location.line for problem in reading.problems] == [1, 2]


def test_problems_are_not_collected_without_end() -> None:
    problems = ProblemCollector()

    def add_all() -> None:
        for line in range(1, 10 * MAX_PROBLEMS):
            problems.add(SourceLocation(Path("a"), line), "wrong")

    with pytest.raises(WorldError) as caught:
        add_all()
    assert len(caught.value.problems) == MAX_PROBLEMS + 1


def test_the_error_says_all_sorted_by_place() -> None:
    a, b = SourceLocation(Path("a.yaml"), 10, 2), SourceLocation(Path("a.yaml"), 9, 1)
    error = WorldError([Problem(a, "late"), Problem(b, "early"), Problem(a, "late")])
    assert str(error) == "a.yaml:9:1: early\na.yaml:10:2: late"


def test_a_key_with_nothing_behind_it_is_blank_and_known(read: Callable[[str], Reading]) -> None:
    reading = read('none:\ntilde: ~\ntext: ""\nword: x\nlist: []\n')
    blank = [key for key in (*reading.section.keys(), "missing") if reading.section.is_blank(key)]
    assert blank == ["none", "tilde", "missing"]
    reading.section.finish()
    assert reading.problems == []
