"""Which tests ``python -m tests.reached`` finds for a change."""

from __future__ import annotations

from pathlib import PurePosixPath

import pytest

from tests.reached import ROOT, mirrors, reach, reached_tests


def test_a_module_reaches_its_importers_and_theirs() -> None:
    imports = {"a": {"b"}, "b": {"c"}, "c": set(), "d": {"a", "d"}, "e": {"f"}, "f": {"e"}}
    assert reach({"c"}, imports) == {"a", "b", "c", "d"}
    assert reach({"e"}, imports) == {"e", "f"}
    assert reach(set(), imports) == set()


@pytest.mark.parametrize(
    ("changed", "test"),
    [
        ("kit/sim/physics.py", "tests/sim/test_physics"),
        ("kit/cli/drive.py", "tests/cli/test_drive_pty"),
        ("grader/scoring.py", "tests/grader/test_scoring"),
        ("kit/layers/__init__.py", "tests/layers/test_layers"),
    ],
)
def test_a_test_mirrors_its_module(changed: str, test: str) -> None:
    assert test in mirrors(PurePosixPath(changed))


def test_a_change_finds_the_tests_that_import_it_and_leaves_out_others() -> None:
    tests = reached_tests([PurePosixPath("kit/layers/cover.py")])
    assert "tests/layers/test_cover.py" in tests
    assert "tests/sim/test_physics.py" not in tests
    assert all((ROOT / test).exists() for test in tests)


def test_data_commands_and_removed_files_have_tests() -> None:
    assert "tests/test_every_map.py" in reached_tests([PurePosixPath("maps/maze/world.yaml")])
    assert "tests/cli" in reached_tests([PurePosixPath("kit/cli/train.py")])
    assert "tests/learning/tasks/test_learning_task.py" in reached_tests(
        [PurePosixPath("kit/learning/tasks/turn.yaml")]
    )
    assert reached_tests([PurePosixPath("kit/layers/gone.py")]) == ["tests/test_floors.py"]
