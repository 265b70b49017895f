"""Every folder of ``bad_worlds`` is refused for the causes its ``expected.yaml`` lists, and for no others."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest
import yaml

from kit.world.loading import load_world
from kit.world.plugin_reader import PluginReader
from kit.world.problems import Problem, WorldError
from tests.cases import every_case

FOLDER = Path(__file__).parent / "bad_worlds"
NAMES = sorted(path.parent.name for path in FOLDER.glob("*/expected.yaml"))


@every_case("name", NAMES)
def test_refused_for_these_causes_only(name: str, devices: Mapping[str, PluginReader]) -> None:
    folder = FOLDER / name
    with pytest.raises(WorldError) as caught:
        load_world(folder / "world.yaml", plugin_readers=devices)
    unexplained = list(caught.value.problems)
    for file, line, *words in yaml.safe_load((folder / "expected.yaml").read_text()):
        found = [p for p in unexplained if _is(p, folder / file, line, [str(word) for word in words])]
        assert len(found) == 1, f"{file}:{line} {words} in\n{caught.value}"
        unexplained.remove(found[0])
    assert not unexplained


def _is(problem: Problem, file: Path, line: int, words: list[str]) -> bool:
    return (
        problem.location.file == file
        and problem.location.line == line
        and all(word in problem.message for word in words)
    )


def test_there_are_many() -> None:
    assert len(NAMES) > 70
