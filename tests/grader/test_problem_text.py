"""What is wrong with a file that was handed in, in lines that can be worked off one by one."""

from __future__ import annotations

from pathlib import Path

from grader.problem_text import numbered, problems_text
from kit.world.problems import Problem, WorldError
from kit.world.records import SourceLocation


def test_each_problem_has_a_line_of_its_own_without_the_path_of_the_copy() -> None:
    folder = Path("/tmp/copy-7")
    places = [SourceLocation(folder / "task.yaml", line, 1) for line in (2, 5)]
    error = WorldError([Problem(places[0], "no wall\x1b[2J"), Problem(places[1], "no robot\nat all")])
    lines = problems_text(error, folder).splitlines()
    assert len(lines) == 3
    assert lines[0] == ""
    assert lines[1].startswith("(1) task.yaml:2:1: no wall")
    assert lines[2].startswith("(2) task.yaml:5:1: no robot at all")
    assert "\x1b" not in "".join(lines)
    one = problems_text(WorldError([Problem(places[0], "no wall")]), folder)
    assert one == "task.yaml:2:1: no wall"
    assert problems_text(OSError("no disk")) == "no disk"
    assert numbered([]) == ""
