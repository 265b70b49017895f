"""The way from start to target, and its narrowest passage: the door, not the corner in which the robot begins."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.mapmaking.map_drawing import read_drawing
from kit.mapmaking.new_map import write_map
from kit.mapmaking.route import NoRoute

CELL = 0.5
TWO_ROOMS = """\
#############
#S    #     #
#     #     #
#           #
#     #    T#
#############
"""


def test_the_narrowest_passage_is_the_door(tmp_path: Path) -> None:
    made = write_map(tmp_path / "rooms", read_drawing(TWO_ROOMS, cell=CELL), title="Rooms", source="drawn")
    x, y = made.route.narrowest
    assert made.route.width == pytest.approx(CELL, abs=0.08)
    assert x == pytest.approx(6.5 * CELL, abs=0.5)
    assert y == pytest.approx(2.5 * CELL, abs=0.15)
    first, last = made.route.points[0], made.route.points[-1]
    assert first == pytest.approx((1.5 * CELL, 4.5 * CELL), abs=0.05)
    assert last == pytest.approx((11.5 * CELL, 1.5 * CELL), abs=0.05)


def test_chosen_places_stand_away_from_the_walls(tmp_path: Path) -> None:
    plain = TWO_ROOMS.replace("S", " ").replace("T", " ")
    made = write_map(tmp_path / "rooms", read_drawing(plain, cell=CELL), title="Rooms", source="drawn")
    for x, y in (made.start[:2], made.target):
        assert CELL + 0.45 < x < 12 * CELL - 0.45
        assert CELL + 0.45 < y < 5 * CELL - 0.45
    assert abs(made.start.x - made.target[0]) > 3


@pytest.mark.parametrize("mark", ["S", "T"])
@pytest.mark.parametrize("row", [1, 4])
def test_where_one_place_is_drawn_the_other_is_chosen_far_from_it(
    mark: str, row: int, tmp_path: Path
) -> None:
    for column in (1, 11):
        rows = TWO_ROOMS.replace("S", " ").replace("T", " ").splitlines()
        rows[row] = rows[row][:column] + mark + rows[row][column + 1 :]
        plan = read_drawing("\n".join(rows), cell=CELL)
        made = write_map(tmp_path / f"rooms{column}", plan, title="Rooms", source="drawn")
        drawn, chosen = (made.start[:2], made.target) if mark == "S" else (made.target, made.start[:2])
        assert drawn == pytest.approx(((column + 0.5) * CELL, (5.5 - row) * CELL), abs=0.01)
        assert abs(chosen[0] - drawn[0]) > 3


def test_a_map_without_a_second_place_is_refused(tmp_path: Path) -> None:
    with pytest.raises(NoRoute, match="No second place for the start"):
        write_map(tmp_path / "cell", read_drawing("###\n#S#\n###\n", cell=CELL), title="Cell", source="drawn")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("cell", [0.3, CELL])
def test_a_wall_through_the_middle_of_the_drawing_is_no_floor(cell: float, tmp_path: Path) -> None:
    rows = [
        "#" * 13,
        *["#     #     #"] * 5,
        "#           #",
        "#           #",
        "#" * 13,
    ]  # the middle is a wall
    plan = read_drawing("\n".join(rows), cell=cell)
    made = write_map(tmp_path / "rooms", plan, title="Rooms", source="drawn")
    for x, y in (made.start[:2], made.target):
        column, row = int(x / cell), len(rows) - 1 - int(y / cell)
        assert rows[row][column] == " "
    assert abs(made.start.x - made.target[0]) > 6 * cell


def test_a_drawing_that_a_robot_can_leave_is_refused(tmp_path: Path) -> None:
    rows = TWO_ROOMS.splitlines()
    rows[3] = rows[3][:-1]
    with pytest.raises(NoRoute, match=r"at \(6\.\d+, 1\.\d+\)"):
        write_map(tmp_path / "rooms", read_drawing("\n".join(rows), cell=CELL), title="Rooms", source="drawn")
    assert not (tmp_path / "rooms").exists()


def test_a_door_too_narrow_for_the_robot_is_told_with_its_width(tmp_path: Path) -> None:
    with pytest.raises(NoRoute, match=r"0\.2\d m wide"):
        write_map(tmp_path / "rooms", read_drawing(TWO_ROOMS, cell=0.24), title="Rooms", source="drawn")
    assert not (tmp_path / "rooms").exists()


@pytest.mark.long
def test_a_way_through_a_large_map_is_found_and_one_too_large_is_told(tmp_path: Path) -> None:
    rows = ["#" * 121, *[f"#{' ' * 119}#"] * 119, "#" * 121]
    for wall in (40, 80):  # with one door each, half a metre wide
        door = 1 if wall == 40 else 119
        rows[wall] = "#" * door + " " + "#" * (120 - door)
    made = write_map(
        tmp_path / "halls", read_drawing("\n".join(rows), cell=0.5), title="Halls", source="drawn"
    )
    assert made.route.width == pytest.approx(0.5, abs=0.1)
    with pytest.raises(NoRoute, match="too large"):
        write_map(tmp_path / "field", read_drawing("\n".join(rows), cell=2.0), title="Field", source="drawn")
