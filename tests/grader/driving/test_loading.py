"""A program is loaded before its first world is built: its mistakes are told at once, and tried only once."""

from __future__ import annotations

from pathlib import Path

import pytest

from grader.assignment import Shift, Trial
from grader.driving import episodes
from grader.driving.drive_record import GradedDrive
from grader.driving.episodes import ProgramLoading, run_episode
from grader.evidence.contract import EpisodeSpec
from kit.host.failure import FailureKind
from kit.host.sandbox.limits import GRADER_LIMITS
from kit.host.sandbox.sandbox_config import Level
from kit.run.scenario import find_scenario
from tests.grader.conftest import FORWARD

TRIAL = Trial("turn", find_scenario("turn"), 0.2, (1,), (), Shift(), None, True, frozenset())
SPEC = EpisodeSpec(TRIAL, 1, "turn, seed 1", secret=False)

WITHOUT_MAIN = """
import time

time.sleep(0.05)
import rclpy
from rclpy.node import Node

rclpy.init()
node = Node("alone")
seen = [name for name, kinds in node.get_topic_names_and_types()]
assert "/scan" in seen or "/static_laser" in seen, seen
rclpy.spin(node)
"""


def no_world(*arguments: object, **options: object) -> None:
    raise AssertionError("a world was built")


def run(folder: Path, source: str, loading: ProgramLoading | None = None) -> object:
    file = folder / "controller.py"
    file.write_text(source)
    return run_episode(SPEC, file, limits=GRADER_LIMITS, level=Level.LIMITED, loading=loading)


@pytest.mark.parametrize(
    ("source", "kind", "told"),
    [
        ("def main(:\n", FailureKind.SYNTAX, "controller.py:1: SyntaxError"),
        ("import rclpy\nspeed = fast\n", FailureKind.EXCEPTION, "controller.py:2: NameError"),
        ("import no_such_module\n", FailureKind.IMPORT, "controller.py:1: ModuleNotFoundError"),
    ],
    ids=["syntax", "name", "import"],
)
def test_no_world_is_built_for_a_program_that_cannot_be_loaded(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, source: str, kind: FailureKind, told: str
) -> None:
    monkeypatch.setattr(episodes, "Simulation", no_world)
    loading = ProgramLoading()
    first = run(tmp_path, source, loading)
    assert first.failure.kind is kind
    assert str(first.failure).startswith(told)
    monkeypatch.setattr(episodes, "NodeProcess", no_world)
    assert run(tmp_path, source, loading).failure == first.failure


def test_a_program_that_starts_late_finds_the_world(tmp_path: Path) -> None:
    """One without a main() uses the graph while it is loaded, and has slept before."""
    drive = run(tmp_path, WITHOUT_MAIN)
    assert drive.failure is None
    assert isinstance(drive, GradedDrive)
    assert drive.connections.nodes == ("/alone",)


def test_a_program_that_stops_in_a_world_is_tried_in_the_next(tmp_path: Path) -> None:
    loading = ProgramLoading()
    stops = FORWARD.replace("rclpy.spin(Forward())", "Forward().no_such_method()")
    assert run(tmp_path, stops, loading).failure.kind is FailureKind.EXCEPTION
    assert loading.failure is None
    assert run(tmp_path, FORWARD, loading).failure is None
