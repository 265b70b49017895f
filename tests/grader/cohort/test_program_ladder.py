"""A ladder of programs: who is stronger, how surely, and what the verb prints."""

from __future__ import annotations

import csv
import os
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from grader.cli.ladder import ladder
from grader.cohort.program_ladder import LadderRace, find_programs, fit_elo, race_all, rank
from grader.look_alikes import outline
from kit.host.sandbox import probe
from kit.school.game.levels import find_level

FORWARD = """
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node

rclpy.init()
node = Node("forward")
drive = node.create_publisher(Twist, "cmd_vel", 1)


def go():
    command = Twist()
    command.linear.x = {speed}
    drive.publish(command)


node.create_timer(0.1, go)
rclpy.spin(node)
"""


def test_elo_is_the_models() -> None:
    assert fit_elo(np.zeros((3, 3))) == pytest.approx([0.0, 0.0, 0.0])
    many = np.array([[0.0, 7500.0], [2500.0, 0.0]])
    first, second = fit_elo(many)
    assert first - second == pytest.approx(
        400.0 * np.log10(3.0), abs=1.0
    )  # three wins of four: three times as strong


def race(program: str, level: int, seconds: float, *, reached: bool = True, bumps: int = 0) -> LadderRace:
    return LadderRace(program, f"level {level}", reached, seconds, bumps)


def test_a_race_is_won_at_the_goal_then_cleanly_then_by_time() -> None:
    races = []
    for level in range(6):
        races += [
            race("bumps", level, 3.0, bumps=1),
            race("quick", level, 5.0),
            race("slow", level, 9.0),
            race("lost", level, 1.0, reached=False),
            race("lost too", level, 2.0, reached=False),
        ]
    rows = rank(races)
    assert [row.program for row in rows] == ["quick", "slow", "bumps", "lost", "lost too"]
    by_name = {row.program: row for row in rows}
    assert by_name["lost"].elo == pytest.approx(by_name["lost too"].elo)  # a draw
    assert by_name["lost"].wins == 3.0
    assert by_name["quick"].wins == by_name["quick"].races == 24


def test_an_interval_is_wide_where_levels_disagree() -> None:
    equal = [
        race(name, level, 5.0 + (level % 2 - 0.5) * sign)
        for level in range(8)
        for name, sign in (("a", 1), ("b", -1))
    ]
    first, second = rank(equal)
    assert first.elo == pytest.approx(second.elo, abs=1e-6)
    assert first.interval[1] - first.interval[0] > 50.0
    sure = [race(name, level, seconds) for level in range(8) for name, seconds in (("a", 1.0), ("b", 2.0))]
    best, worst = rank(sure)
    assert best.program == "a"
    assert best.interval[0] > worst.interval[1]


def test_programs_are_files_and_folders_with_one(tmp_path: Path) -> None:
    (tmp_path / "ada.py").write_text("")
    (tmp_path / "bob").mkdir()
    (tmp_path / "bob" / "mine.py").write_text("")
    (tmp_path / "two").mkdir()
    for name in ("a.py", "b.py"):
        (tmp_path / "two" / name).write_text("")
    programs, passed_over = find_programs(tmp_path)
    assert set(programs) == {"ada", "bob"}
    assert [each.partition(" ")[0] for each in passed_over] == ["two"]


def test_one_program_is_no_ladder(tmp_path: Path) -> None:
    (tmp_path / "ada.py").write_text("")
    result = CliRunner().invoke(ladder, [str(tmp_path)])
    assert result.exit_code == 2
    assert "two programs" in result.output


@pytest.mark.long
def test_the_verb_races_and_ranks(tmp_path: Path) -> None:
    for name, speed in (("quick", 0.4), ("slow", 0.2), ("stands", 0.0)):
        (tmp_path / f"{name}.py").write_text(FORWARD.format(speed=speed))
    result = CliRunner().invoke(ladder, [str(tmp_path), "--level", "two-doors", "--csv"])
    assert result.exit_code == 0, result.output
    header, *rows = csv.reader(result.output.splitlines())
    assert header[:3] == ["place", "program", "elo"]
    assert len(rows) == 3


def test_links_and_what_is_no_file_are_no_programs(tmp_path: Path) -> None:
    (tmp_path / "other.txt").write_text("")
    (tmp_path / "linked.py").symlink_to(tmp_path / "other.txt")
    (tmp_path / "folder.py").mkdir()
    os.mkfifo(tmp_path / "pipe.py")
    (tmp_path / "bob").mkdir()
    (tmp_path / "eve").symlink_to(tmp_path / "bob")
    (tmp_path / "bob" / "mine.py").write_text("")
    programs, passed_over = find_programs(tmp_path)
    assert set(programs) == {"bob"}
    assert {each.partition(" ")[0] for each in passed_over} == {
        "other.txt",
        "linked.py",
        "folder.py",
        "pipe.py",
        "eve",
    }


@pytest.mark.parametrize(
    "others", [("ada/mine.py",), ("ADA.py",), ("\u0430da.py",), ("ada.py /mine.py",), (".ada.py", "ada/x.py")]
)
def test_no_program_takes_the_place_or_the_look_of_another(others: tuple[str, ...], tmp_path: Path) -> None:
    (tmp_path / "ada.py").write_text("# the first")
    for other in others:
        (tmp_path / other).parent.mkdir(exist_ok=True)
        (tmp_path / other).write_text("# another")
    programs, passed_over = find_programs(tmp_path)
    assert sorted(file.read_text() for file in programs.values()).count("# the first") == 1
    assert len(programs) + len(passed_over) == 1 + len(others)
    assert len({outline(name) for name in programs}) == len(programs)


def test_programs_of_others_are_not_raced_at_level_0_by_silence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(probe, "is_level_available", lambda level: False)
    for name in "ab":
        (tmp_path / f"{name}.py").write_text("")
    result = CliRunner().invoke(ladder, [str(tmp_path)])
    assert result.exit_code == 2
    assert "--unconfined" in result.output


@pytest.mark.long
def test_broken_programs_are_named_and_end_no_ladder(tmp_path: Path) -> None:
    """Neither a formula nor a terminal's escape comes out of a name or an error."""
    (tmp_path / "=1+1,a.py").write_text("def main(:")
    (tmp_path / "b\x1b[31m.py").write_text('raise ValueError("\\x1b[2J")')
    (tmp_path / "huge.py").write_text("x = 1\n" * 200_000)
    (tmp_path / "nul.py").write_bytes(b"\0")
    result = CliRunner().invoke(ladder, [str(tmp_path), "--level", "two-doors", "--csv"])
    assert result.exit_code == 0, result.output
    assert "\x1b" not in result.output
    rows = list(csv.reader(result.stdout.splitlines()))
    assert [len(row) for row in rows] == [7] * 5
    assert sorted(row[1] for row in rows[1:])[0] == "'=1+1,a"
    for word in ("SyntaxError", "ValueError", "larger than", "null bytes"):
        assert word in result.stderr


@pytest.mark.long
def test_a_race_has_a_wall_clock(tmp_path: Path) -> None:
    """A program that waits within its time for each reply would stand there for as long as a race has ticks."""
    slow = "import rclpy, select\nfrom rclpy.node import Node\nrclpy.init()\nnode = Node('slow')\n"
    slow += "node.create_timer(0.01, lambda: select.select([], [], [], 0.2))\nrclpy.spin(node)\n"
    (tmp_path / "slow.py").write_text(slow)
    (race,) = race_all(find_programs(tmp_path)[0], [find_level("left-turn")], wall_limit_s=1.0)
    assert not race.reached
    assert "longer than 1 s" in race.failure


SPY = """
import os

here = os.path.dirname(os.path.abspath(__file__))
raise RuntimeError(sorted(name for _, folders, files in os.walk(here) for name in (*folders, *files)))
"""


def test_a_program_sees_none_of_the_others_but_what_is_its_own(tmp_path: Path) -> None:
    for name in ("spy.py", "first/program.py", "second/program.py"):
        file = tmp_path / name
        file.parent.mkdir(exist_ok=True)
        file.write_text(SPY)
    (tmp_path / "first" / "weights.npz").write_bytes(b"")
    programs, _ = find_programs(tmp_path)
    failures = {race.program: race.failure for race in race_all(programs, [find_level("left-turn")])}
    assert "['spy.py']" in failures["spy"]
    assert "['program.py', 'weights.npz']" in failures["first"]
    assert "['program.py']" in failures["second"]
