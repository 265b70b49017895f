"""What launch files for launch_testing use outside their tests."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType

import pytest

from kit.ros.launch.context import LaunchError
from kit.ros.launch.description_sources import description_of
from kit.ros.launch.testing.marks import parametrize


@pytest.mark.parametrize(
    ("names", "values", "wanted"),
    [
        ("speed", [1, 2], [{"speed": 1}, {"speed": 2}]),
        ("speed, side", [(1, "left")], [{"speed": 1, "side": "left"}]),
        (["speed", "side"], [(1, "left")], [{"speed": 1, "side": "left"}]),
    ],
)
def test_a_description_is_made_for_each_value(
    names: object, values: list[object], wanted: list[dict]
) -> None:
    made = parametrize(names, values)(lambda **arguments: arguments)()
    assert [arguments for _, arguments in made] == wanted
    assert [function() for function, _ in made] == wanted


def test_a_file_of_launch_testing_is_told_from_one_that_lacks_its_function() -> None:
    module = ModuleType("x")
    module.__file__ = str(Path("x.launch.py"))
    with pytest.raises(LaunchError, match=r"no generate_launch_description\(\) in it$"):
        description_of(module)
    module.generate_test_description = lambda: None  # type: ignore[attr-defined]  # as its author wrote it
    with pytest.raises(LaunchError, match="kit ros launch_test"):
        description_of(module)
