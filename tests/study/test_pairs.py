"""The pairs of Tables 4.6 and 5.3, driven by the nodes in processes of their own."""

from __future__ import annotations

import math
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from kit.cli.fields import _table_row
from kit.controllers import find_controller
from kit.run.scenario import Scenario, find_scenario, scenario_in_file
from kit.study.pairs import (
    START_SHIFT,
    TABLE_46,
    TABLE_53,
    PairRunResult,
    PairSummary,
    PrintedPairResult,
    run_once,
    run_repeatedly,
    shift_start_poses,
)
from kit.world.catalogue import maps_folder

NINETY = {"pair_turn_left_90": 0.54, "pair_turn_right_90": 0.62}
"""The dissertation's adjacency."""


def at(printed: PrintedPairResult) -> Scenario:
    return find_scenario(printed.map, printed.case)


@pytest.mark.long
@pytest.mark.parametrize("printed", [pytest.param(each, id=each.case) for each in (*TABLE_46, *TABLE_53)])
def test_abreast_reaches_every_target_side_by_side(printed: PrintedPairResult) -> None:
    found = run_once(at(printed), find_controller("abreast"))
    assert (found.end, found.why) == ("reached", "")
    assert found.by_rays >= 0.85  # noise in the lasers allows 0.96
    assert found.by_geometry == 1.0
    assert found.adjacency_score > 0.98
    assert found.nearest_wall_m > 0.05
    assert found.jerk < 0.5


@pytest.mark.long
@pytest.mark.parametrize(
    "printed", [pytest.param(each, id=each.case) for each in (*TABLE_46, *TABLE_53) if each.accuracy == 1.0]
)
def test_the_dissertations_controller_where_it_succeeds(printed: PrintedPairResult) -> None:
    found = run_once(at(printed), find_controller("fields"))
    assert found.end == "reached", found.why
    assert printed.adjacency is not None
    assert found.by_geometry == pytest.approx(printed.adjacency, abs=0.2)
    if printed.case in NINETY:
        assert found.by_geometry >= NINETY[printed.case]


@pytest.mark.long
@pytest.mark.parametrize("case", ["pair_turn_left_180", "pair_turn_right_180"])
def test_the_dissertations_controller_fails_where_it_did_and_the_reason_is_shown(case: str) -> None:
    found = run_once(find_scenario("pair_turn_180", case), find_controller("fields"))
    assert found.end == "stuck"
    assert "trap" in found.why
    assert "46%" in found.why
    assert found.by_geometry < 0.1


@pytest.mark.long
def test_the_same_seed_is_the_same_run() -> None:
    place = shift_start_poses(find_scenario("pair_straight"), 5, 1)
    assert run_once(place, find_controller("abreast"), seed=7) == run_once(
        place, find_controller("abreast"), seed=7
    )


def test_starts_differ_a_little_but_for_the_first() -> None:
    place = find_scenario("pair_turn")
    assert shift_start_poses(place, 3, 0).starts == place.starts
    moved = shift_start_poses(place, 3, 1)
    assert moved.starts == shift_start_poses(place, 3, 1).starts
    assert moved.starts != shift_start_poses(place, 4, 1).starts
    for one, other in zip(place.starts, moved.starts, strict=True):
        assert all(0 < abs(a - b) <= most for a, b, most in zip(one, other, START_SHIFT, strict=True))


def test_a_collision_says_who_touched_what(tmp_path: Path) -> None:
    straight = tmp_path / "straight.py"
    straight.write_text(
        "from geometry_msgs.msg import Twist\n"
        "from rclpy.node import Node\n\n"
        "class Straight(Node):\n"
        "    def __init__(self):\n"
        "        super().__init__('straight')\n"
        "        self.drives = [self.create_publisher(Twist, f'/{name}/cmd_vel', 10) for name in ('left', 'right')]\n"
        "        self.create_timer(0.1, self.go)\n"
        "    def go(self):\n"
        "        command = Twist()\n"
        "        command.linear.x = 1.0\n"
        "        for drive in self.drives:\n"
        "            drive.publish(command)\n"
    )
    found = run_once(find_scenario("pair_turn"), find_controller(str(straight)))
    assert found.end == "collided"
    assert "touched a wall" in found.why


@pytest.mark.long
def test_where_no_way_is_wide_enough_it_says_so_and_does_not_drive(tmp_path: Path) -> None:
    pair, door = find_scenario("pair_straight"), maps_folder() / "hall_center_door"
    for file in (*door.glob("map.*"), *(maps_folder() / "robots").glob("*.yaml")):
        shutil.copy(file, tmp_path)
    text = pair.world.file.read_text()
    (tmp_path / "world.yaml").write_text(text.replace("../hall_straight/", "").replace("../robots/", ""))
    narrow = replace(scenario_in_file(tmp_path / "world.yaml"), case=pair.case, robot="left")
    found = run_once(narrow, find_controller("abreast"))
    assert found.end == "stuck"
    assert "Not driving. No path" in found.why
    assert "wide enough for two robots side by side, 0.49 m wide" in found.why
    assert found.path_m == 0


def test_a_summary_counts_ways_to_fail() -> None:
    good = PairRunResult("reached", "", 10.0, 1.0, 0.9, 1.0, 3.0, 0.1, 0.2)
    bad = replace(good, end="stuck", why="there", nearest_wall_m=0.05, time_s=30.0)
    found = PairSummary.of("case", "who", [good, bad, replace(bad, why="elsewhere"), good])
    assert found.accuracy == 0.5
    assert found.failures == ((2, "stuck: there"),)
    assert found.nearest_wall_m == 0.05
    assert found.time_s == 20.0


@pytest.mark.long
def test_runs_are_told_as_they_end() -> None:
    told: list[int] = []
    found = run_repeatedly(
        find_scenario("pair_straight"),
        find_controller("abreast"),
        runs=2,
        on_run=lambda number, _: told.append(number),
    )
    assert told == [0, 1]
    assert (found.runs, found.accuracy) == (2, 1.0)


def test_a_controller_that_fails_before_anything_was_measured_is_told(tmp_path: Path) -> None:
    broken = tmp_path / "broken.py"
    broken.write_text("raise RuntimeError('no battery')\n")
    found = run_once(find_scenario("pair_turn"), find_controller(str(broken)))
    assert found.end == "failed"
    assert "no battery" in found.why


def test_a_program_that_failed_is_no_result_of_its_method() -> None:
    good = PairRunResult("reached", "", 10.0, 1.0, 0.9, 1.0, 3.0, 0.1, 0.2)
    late = replace(good, end="failed", why="it did not come back", by_geometry=math.nan, by_rays=math.nan)
    printed = PrintedPairResult("straight", "pair_straight", "pair_straight", 1.0, 0.28)
    whole, partly = (PairSummary.of("case", "who", outcomes) for outcomes in ([good] * 2, [good, late]))
    assert (whole.broken, partly.broken) == (0, 1)
    first, second = (_table_row(printed, (each,)) for each in (whole, partly))
    assert first.split() == ["straight", "1.00", "0.28", "1.00", "0.90", "1.00"]
    assert second.split() == ["straight", "1.00", "0.28", "-", "-", "-"]
