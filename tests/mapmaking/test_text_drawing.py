"""A drawing in characters becomes a map with a way through it, or its mistake is named with line and column."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from kit.cli import main
from kit.mapmaking.map_sketch import DrawingError, read_drawing
from kit.run.scenario import find_scenario
from tests.cases import every_case

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
        (HALL.replace("#       T#", "#    #  T#"), (), "No way leads"),
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
    assert "there already" in make(tmp_path, HALL).output
    result = CliRunner().invoke(
        main, ["maps", "new", "../x", "--from", "-", "--workspace", str(tmp_path)], input=HALL
    )
    assert result.exit_code == 2
    assert "cannot be a map's name" in result.output


def test_own_maps_are_listed_and_shown_by_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("KIT_WORKSPACE", str(tmp_path))
    assert make(tmp_path, HALL).exit_code == 0
    assert str(tmp_path / "worlds" / "hall") in CliRunner().invoke(main, ["maps"]).output
    shown = CliRunner().invoke(main, ["maps", "hall"])
    assert shown.exit_code == 0
    assert "from (0.75, 1.75" in shown.output
