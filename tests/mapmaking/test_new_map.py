"""Sketches: what is drawn is what the reader of drawings reads."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path

import pytest
from click.testing import CliRunner, Result
from hypothesis import given, settings
from hypothesis import strategies as st

import kit
from kit.cli import main
from kit.learning.maps.batch_map import load_batch_map
from kit.learning.policies.policy_node import robot_topics
from kit.mapmaking.map_drawing import DrawingError, read_drawing
from kit.mapmaking.map_sketch import SCALES, MapSketch, squares_between
from kit.mapmaking.new_map import write_map
from kit.mapmaking.route import NoRoute
from kit.run.scenario import find_scenario
from tests.cases import every_case

SQUARES = st.tuples(st.integers(-3, 14), st.integers(-3, 12))


def test_a_sketch_reads_as_what_was_drawn() -> None:
    sketch = MapSketch.room(8, 5, 0.25).drawn("S", (1, 1)).drawn_line("#", (4, 1), (4, 2)).drawn("T", (6, 3))
    assert sketch.text == "########\n#S  #  #\n#   #  #\n#     T#\n########\n"
    plan = read_drawing(sketch.text, cell=sketch.cell)
    assert plan.size == sketch.size == (2.0, 1.25)
    assert plan.start == (0.375, 0.875)
    assert plan.target == (1.625, 0.375)


@settings(max_examples=50)
@given(st.lists(st.tuples(st.sampled_from("# ST"), SQUARES, SQUARES), max_size=12))
def test_whatever_is_drawn_keeps_its_size_and_one_start(
    strokes: list[tuple[str, tuple[int, int], tuple[int, int]]],
) -> None:
    sketch = MapSketch.room(12, 10)
    for mark, first, last in strokes:
        sketch = sketch.drawn_line(mark, first, last)  # type: ignore[arg-type]  # one of the four
        if mark in "ST" and sketch.is_inside(last):
            assert sketch.find(mark) == last  # type: ignore[arg-type]  # one of the four
    assert {len(row) for row in sketch.rows} == {12}
    assert len(sketch.rows) == 10
    assert all(sketch.text.count(mark) <= 1 for mark in "ST")


@given(SQUARES, SQUARES)
def test_a_line_is_connected_and_as_long_as_its_longer_side(
    first: tuple[int, int], last: tuple[int, int]
) -> None:
    squares = squares_between(first, last)
    assert (squares[0], squares[-1]) == (first, last)
    assert len(squares) == max(abs(last[0] - first[0]), abs(last[1] - first[1])) + 1
    assert all(abs(a - c) <= 1 and abs(b - d) <= 1 for (a, b), (c, d) in pairwise(squares))


def test_the_scale_goes_from_finest_to_coarsest_and_stays_there() -> None:
    sketch = MapSketch.room(8, 5)
    assert sketch.scaled(-100).cell == SCALES[0]
    assert sketch.scaled(100).cell == SCALES[-1]
    assert sketch.scaled(1).scaled(-1) == sketch


@pytest.mark.parametrize("size", [(3, 10), (10, 0), (401, 10)])
def test_a_sheet_of_no_use_is_refused(size: tuple[int, int]) -> None:
    with pytest.raises(ValueError, match="4 to 400"):
        MapSketch.room(*size)


HALL = """
##########
#S   #   #
#    #   #
#       T#
##########
"""


def make(folder: Path, text: str, *options: str) -> Result:
    return CliRunner().invoke(
        main, ["maps", "new", "hall", "--from", "-", "--workspace", str(folder), *options], input=text
    )


def test_walls_start_and_target_are_where_they_were_drawn(tmp_path: Path) -> None:
    result = make(tmp_path, HALL)
    assert result.exit_code == 0, result.output
    scenario = find_scenario(str(tmp_path / "worlds" / "hall"))
    assert scenario.case is not None
    assert scenario.case.start[:2] == pytest.approx((0.75, 1.75))
    assert scenario.case.target == pytest.approx((4.25, 0.75))
    (layer,) = scenario.world.layers
    assert layer.walls is not None
    assert layer.walls.segments[:, ::2].max() == pytest.approx(5.0)
    assert layer.walls.segments[:, 1::2].max() == pytest.approx(2.5)


def test_without_marks_two_places_far_apart_are_chosen(tmp_path: Path) -> None:
    result = make(tmp_path, HALL.replace("S", " ").replace("T", " "))
    assert result.exit_code == 0, result.output
    case = find_scenario(str(tmp_path / "worlds" / "hall")).case
    assert case is not None
    assert abs(case.start[0] - case.target[0]) > 2


@every_case(
    ("text", "told"),
    [
        ("", "empty"),
        ("   \n", "empty"),
        ("S T", "no wall"),
        ("##\n#x", "line 2, column 2"),
        ("#S\n#S", "second S"),
        ("#" * 500, "at most 400"),
    ],
)
def test_a_mistake_names_its_place(text: str, told: str) -> None:
    with pytest.raises(DrawingError, match=told):
        read_drawing(text)


@pytest.mark.parametrize(
    ("text", "options", "told"),
    [
        (HALL.replace("#       T#", "#    #  T#"), (), "There is no path"),
        (HALL, ("--cell", "0.1"), "larger scale"),
    ],
    ids=["walled in", "too narrow"],
)
def test_a_map_without_a_way_is_not_written(
    tmp_path: Path, text: str, options: tuple[str, ...], told: str
) -> None:
    result = make(tmp_path, text, *options)
    assert result.exit_code == 2
    assert told in result.output
    assert list((tmp_path / "worlds").iterdir()) == []


def test_a_name_that_is_taken_or_is_none_is_refused(tmp_path: Path) -> None:
    assert make(tmp_path, HALL).exit_code == 0
    assert "already exists" in make(tmp_path, HALL).output
    result = CliRunner().invoke(
        main, ["maps", "new", "../x", "--from", "-", "--workspace", str(tmp_path)], input=HALL
    )
    assert result.exit_code == 2
    assert "cannot be a map's name" in result.output


def test_own_maps_are_listed_and_shown_by_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("KIT_WORKSPACE", str(tmp_path))
    made = make(tmp_path, HALL)
    assert made.exit_code == 0
    assert "kit drive hall\n" in made.output  # what follows finds it by its name, too
    assert str(tmp_path / "worlds" / "hall") in CliRunner().invoke(main, ["maps"]).output
    shown = CliRunner().invoke(main, ["maps", "hall"])
    assert shown.exit_code == 0
    assert "from (0.75, 1.75" in shown.output


@pytest.mark.parametrize(
    ("room", "said"),
    [
        ("###\n# #\n###", "No place for start and target was found"),
        ("###\n#S#\n###", "No second place for the start was found"),
        ("###\n#T#\n###", "No second place for the target was found"),
        ("####\n#ST#\n####", "Start and target are 0.30 m apart"),
    ],
)
def test_places_that_nobody_gave_are_not_blamed(tmp_path: Path, room: str, said: str) -> None:
    plan = read_drawing(room, cell=0.3 if "ST" in room else 0.5)
    with pytest.raises(NoRoute, match=said):
        write_map(tmp_path / "small", plan, title="Small", source="drawn")
    assert list(tmp_path.iterdir()) == []


ROOM = "##########\n#S       #\n#        #\n#       T#\n##########\n"


def test_two_robots_on_a_map_of_ones_own_see_each_other_and_are_trained(tmp_path: Path) -> None:
    """Side by side near the start, each with topics of its own; found by name from Python too."""
    (tmp_path / "room.txt").write_text(ROOM)
    words = ["maps", "new", "duo", "--from", str(tmp_path / "room.txt"), "--pair"]
    made = CliRunner().invoke(main, words)
    assert made.exit_code == 0, made.output
    card = kit.find_map("duo")
    assert (card.robot, card.partner) == ("left", "right")
    (case,) = card.cases
    assert case.partner_start is not None
    assert math.dist(case.start[:2], case.partner_start[:2]) == pytest.approx(0.4, abs=0.01)
    assert len(load_batch_map(card).starts) == 2
    new = CliRunner().invoke(main, ["task", "new", "both", "--from", "duo"])
    assert new.exit_code == 0, new.output
    assert "neither raced" not in new.output
    task = kit.find_task("both")
    assert (task.robots, robot_topics(task)[1].scans) == (2, "/right/static_laser")


def test_robots_that_share_their_topics_are_told_at_the_check(tmp_path: Path) -> None:
    (tmp_path / "room.txt").write_text(ROOM)
    CliRunner().invoke(main, ["maps", "new", "same", "--from", str(tmp_path / "room.txt"), "--pair"])
    world = kit.find_map("same").world_file
    lines = [line for line in world.read_text().splitlines() if "namespace" not in line]
    world.write_text("\n".join(lines) + "\n")
    CliRunner().invoke(main, ["task", "new", "alike", "--from", "same"])
    told = " ".join(CliRunner().invoke(main, ["task", "check", "alike"]).output.split())
    assert "left and right share cmd_vel" in told.replace("/", "")
    assert "namespace" in told


def test_a_robot_looks_where_it_can_drive_straight(tmp_path: Path) -> None:
    for number, (text, degrees) in enumerate(
        (
            ("###########\n#S       T#\n#         #\n###########\n", 0.0),
            ("###########\n#T       S#\n#         #\n###########\n", 180.0),
            ("#####\n#S  #\n#   #\n#   #\n#   #\n#T  #\n#####\n", -90.0),
        )
    ):
        result = make(tmp_path / str(number), text)
        assert result.exit_code == 0, result.output
        case = find_scenario(str(tmp_path / str(number) / "worlds" / "hall")).case
        assert case is not None
        assert math.cos(case.start.theta - math.radians(degrees)) > 0.98
