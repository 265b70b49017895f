"""Programs in the shape of every program of ROS 2's examples for rclpy and of demo_nodes_py run as they are."""

from __future__ import annotations

import pytest

from kit.ros.packages import read_package
from tests.ros.examples.table import EXAMPLES, FOLDER, Example, run_example


@pytest.mark.sampled(22)
@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: f"{example.package}-{example.program}")
def test_an_example_runs(example: Example) -> None:
    outcome = run_example(example)
    assert outcome.works, outcome.reason


@pytest.mark.parametrize("package", ["examples_rclpy", "demo_nodes_py"])
def test_every_program_is_in_the_table(package: str) -> None:
    programs = {executable.name for executable in read_package(FOLDER / package).executables}
    named = {example.program for example in EXAMPLES if example.package == package}
    partners = {
        words.split()[0] for example in EXAMPLES if example.package == package for words in example.partners
    }
    assert programs == named | partners
    assert len(named) == {"examples_rclpy": 31, "demo_nodes_py": 13}[package]


def test_an_example_that_does_not_show_what_it_should_fails() -> None:
    outcome = run_example(Example("examples_rclpy", "trigger_guard_condition", ("never",), ends=True))
    assert not outcome.works
    assert "'never' was never printed" in outcome.reason
