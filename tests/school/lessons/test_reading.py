"""A lesson's file: what is read, and how mistakes are told."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.school.lessons.reading import UnknownLesson, exercise_scene, find_lesson, lesson_names, read_lesson
from kit.school.lessons.records import CommandKind, GraphChannel, GraphScene, Lesson, StepKind
from kit.world.problems import WorldError
from tests.school.lessons.conftest import LESSON, write_lesson


def test_what_is_read(lesson: Lesson) -> None:
    assert [step.kind for step in lesson.steps] == [StepKind.PREDICT, StepKind.EXPLAIN, StepKind.MAKE]
    assert lesson.steps[0].options[0].is_right
    assert lesson.steps[1].commands[0].kind is CommandKind.ALONE
    (exercise,) = lesson.exercises
    assert (lesson.exercise_subject(exercise), lesson.step_subject(lesson.steps[2])) == (
        "01-colours/colour",
        "01-colours/3",
    )


@pytest.mark.parametrize("name", ["01-colours", "colours", "01", "1"])
def test_a_lesson_is_found_by_its_name_and_number(tmp_path: Path, name: str) -> None:
    write_lesson(tmp_path)
    assert find_lesson(name, tmp_path).name == "01-colours"
    assert lesson_names(tmp_path) == ("01-colours",)


def number_the_lesson(folder: Path) -> None:
    (folder / "units.yaml").write_text(
        "units:\n"
        "  - {title: First, opener: Begin here., lessons: [00-light, 05-shade]}\n"
        "  - {title: Second, opener: Go on., lessons: [04-sun, 01-colours]}\n"
    )


@pytest.mark.parametrize("name", ["B2", "b2", "1", "colours"])
def test_a_number_in_the_course_does_not_take_an_older_name(tmp_path: Path, name: str) -> None:
    write_lesson(tmp_path)
    number_the_lesson(tmp_path)
    assert find_lesson(name, tmp_path).number == "B2"
    with pytest.raises(UnknownLesson):
        find_lesson("2", tmp_path)


def test_a_text_names_a_lesson_by_its_number_in_the_course(tmp_path: Path) -> None:
    file = write_lesson(tmp_path) / "lesson.yaml"
    number_the_lesson(tmp_path)
    file.write_text(file.read_text().replace("It is red already.", '"See lesson {number 01-colours}."'))
    lesson = find_lesson("colours", tmp_path)
    assert lesson.steps[0].options[1].feedback == "See lesson B2."
    assert "lesson B2" in lesson.steps[0].wording
    file.write_text(file.read_text().replace("{number 01-colours}", "{number 09-colours}"))
    with pytest.raises(WorldError, match="09-colours"):
        read_lesson(file.parent)


def test_an_unknown_lesson_has_a_nearest_one(tmp_path: Path) -> None:
    write_lesson(tmp_path)
    with pytest.raises(UnknownLesson, match='did you mean 1, "Colours"'):
        find_lesson("colors", tmp_path)


MISTAKES = {
    "key": ("summary: What", "sumary: What", "sumary"),
    "kind": ("kind: explain", "kind: explian", "explain"),
    "no right option": ("right: true, ", "", "exactly one"),
    "question": ("    question: What comes next?\n", "", "question"),
    "exercise": ("exercise: colour", "exercise: color", "color/assignment.yaml"),
    "no exercise": ("    exercise: colour\n    file: answers.yaml\n    seconds: 20\n", "", "exercise"),
    "outcome": ("carries: [light]", "carries: [lights]", "light"),
    "too wide": ("(o)", "o" * 77, "76"),
    "too long": ("The light is red.", "red " * 400, "rows"),
    "open code": ("The light is red.", "The `light is red.", "not closed"),
    "no steps": (LESSON[LESSON.index("steps:") :], "steps: []\n", "at least 1"),
    "seconds": ("seconds: 20", "seconds: -1", "seconds"),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_names_its_place_and_the_way_out(tmp_path: Path, mistake: str) -> None:
    old, new, said = MISTAKES[mistake]
    assert old in LESSON
    with pytest.raises(WorldError) as raised:
        read_lesson(write_lesson(tmp_path, LESSON.replace(old, new)))
    assert said in str(raised.value)
    assert "lesson.yaml:" in str(raised.value)


LEARNING = """    learning:
      learners: [{alpha: 0.25}, {algorithm: sarsa, title: The other}]
      episodes: 12
      rewards: {step: -1}
      map: |
        S.G
        ...
"""
LEAST_ROWS = GraphScene((GraphChannel("/light", "/lamp", ("/eye",), 1.0, ()),), 12.0).least_rows
PICTURE = "    picture: |\n      (o)\n"
TEXT = "      It goes round. `kit maps` lists something else.\n"


def items(count: int) -> str:
    return "      - an item\n" * count


def graph(topics: int, rows: int) -> str:
    """A step with a graph, and a text of so many rows."""
    each = "{name: /light, publisher: /lamp, subscribers: [/eye], rate: 1}"
    scene = f"    graph:\n      topics: [{', '.join([each] * topics)}]\n"
    return LESSON.replace(PICTURE, scene).replace("text: The light is red.\n", f"text: |\n{items(rows)}")


@pytest.mark.parametrize(
    ("fits", "does_not", "said"),
    [
        (LESSON.replace(TEXT, items(17)), LESSON.replace(TEXT, items(18)), "rows"),
        (
            LESSON.replace("      (o)\n", "      (o)\n" * 10),
            LESSON.replace("      (o)\n", "      (o)\n" * 11),
            "rows",
        ),
        (graph(4, 1), graph(5, 1), "1 to 4 topics"),
        (graph(1, 19 - LEAST_ROWS), graph(1, 20 - LEAST_ROWS), "rows"),
        (
            LESSON.replace(PICTURE, LEARNING),
            LESSON.replace(PICTURE, LEARNING.replace("[{alpha: 0.25}", "[{alpha: 0.25}, {}")),
            "at most 2 learners",
        ),
    ],
    ids=["text", "picture", "topics", "text below a graph", "learners"],
)
def test_what_does_not_fit_on_24_rows_is_refused(tmp_path: Path, fits: str, does_not: str, said: str) -> None:
    read_lesson(write_lesson(tmp_path / "fits", fits))
    with pytest.raises(WorldError, match=said):
        read_lesson(write_lesson(tmp_path / "does_not", does_not))


def test_tables_that_learn_are_read(tmp_path: Path) -> None:
    step = read_lesson(write_lesson(tmp_path, LESSON.replace(PICTURE, LEARNING))).steps[0]
    scene = step.learning
    assert scene is not None
    assert step.moves
    assert [(each.algorithm, each.alpha) for each in scene.learners] == [("q-learning", 0.25), ("sarsa", 0.5)]
    assert scene.titles == ("q-learning", "The other")
    assert scene.world.shortest_path_length == 2
    assert scene.world.rewards.step == -1.0


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("S.G", "S.?", "the map has"),
        ("alpha: 0.25", "alpha: -2", "alpha"),
        ("sarsa", "sarsaa", "sarsa"),
        ("    learning:", PICTURE + "    learning:", "one of scene, learning, graph and picture"),
    ],
)
def test_a_mistake_in_them_is_told(tmp_path: Path, old: str, new: str, said: str) -> None:
    with pytest.raises(WorldError) as raised:
        read_lesson(write_lesson(tmp_path, LESSON.replace(PICTURE, LEARNING.replace(old, new))))
    assert said in str(raised.value)


GRAPH = """    graph:
      seconds: 5
      topics:
        - {name: /scan, publisher: /laser, subscribers: [/driver], rate: 10}
        - {name: /log, publisher: /driver, times: [2], asked: log}
      services:
        - {name: /halt, client: /driver, server: /robot, times: [1, 3]}
"""


def test_a_graph_is_read(tmp_path: Path) -> None:
    step = read_lesson(write_lesson(tmp_path, LESSON.replace(PICTURE, GRAPH))).steps[0]
    assert step.moves
    assert step.graph is not None
    scan, log, halt = step.graph.channels
    assert (scan.receivers, scan.rate, scan.times) == (("/driver",), 10.0, ())
    assert (log.receivers, log.rate, log.times, log.asked) == ((), None, (2.0,), "log")
    assert (halt.sender, halt.receivers, halt.is_service) == ("/driver", ("/robot",), True)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("rate: 10", "rate: 0", "rate"),
        (", rate: 10", "", "either a rate or times"),
        ("times: [2]", "times: [9]", "at most the 5 s"),
        ("[/driver]", "[driver]", "begins with /"),
        ("server: /robot, ", "", "server"),
        ("rate: 10", "rate: 10, undelivered: [/other]", "names receivers"),
        ("    graph:", PICTURE + "    graph:", "one of scene, learning, graph and picture"),
    ],
)
def test_a_mistake_in_a_graph_is_told(tmp_path: Path, old: str, new: str, said: str) -> None:
    with pytest.raises(WorldError) as raised:
        read_lesson(write_lesson(tmp_path, LESSON.replace(PICTURE, GRAPH.replace(old, new))))
    assert said in str(raised.value)


def test_the_world_in_which_an_exercise_is_checked_is_known() -> None:
    found = {each.name: exercise_scene(each) for each in find_lesson("09-your-own-controller").exercises}
    assert {name: scene and scene.map_name for name, scene in found.items()} == {
        "circle": "simple",
        "wanderer": "maze",
        "wall_follower": "house",
    }
    in_case = [exercise_scene(each) for each in find_lesson("13-potential-fields").exercises]
    assert "turn_a_to_b" in [each.case for each in in_case if each is not None]
    assert all(exercise_scene(each) is None for each in find_lesson("20-q-learning").exercises)
