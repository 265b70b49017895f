"""Programs that were written outside do what their authors mean: ``python -m tests.ros.outside_programs`` prints the table."""

from __future__ import annotations

from typing import Final

import pytest

from tests.ros.outside_programs.judge import SETS, OutsideProgram, programs_of, run_program

MISTAKEN: Final = {
    "12_turn_pid": "after its last zero command it handles one more odometry and commands again, and ends: the base turns on",
    "44_turtle_polygon_relative": "awaits a service in a timer's callback, both in the node's mutually exclusive group: a deadlock",
}
"""Programs that do not do in ROS 2 what their author means either, and why."""

NOT_DONE: Final = {
    "01_time_machine": "publishes a /clock of its own, which no node's clock follows here",
    "11_split_bag": "writes a bag in several files, which is refused",
}
"""Programs of what the kit does not do, and says so."""

ENDLESS: Final = {
    "05_two_processes": "has nodes in processes that it forks, which is refused, and waits for them for ever"
}
"""Likewise, and they do not end."""

PROGRAMS: Final = [each for name in SETS for each in programs_of(name) if each.name not in ENDLESS]


@pytest.mark.long
@pytest.mark.daily(6)
@pytest.mark.parametrize("program", PROGRAMS, ids=lambda each: each.name)
def test_a_program_does_what_its_author_means(program: OutsideProgram) -> None:
    complaints = run_program(program).complaints
    assert bool(complaints) == (program.name in MISTAKEN | NOT_DONE), complaints
