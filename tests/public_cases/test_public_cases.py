"""What people reported elsewhere, made anew: each ``NN_name.yaml`` has the case and its siblings, with what is right of each.

``words`` are those of a command of the kit, which is run in a folder with the ``files``; a case adds its ``program``, which
comes after ``before``, its ``names`` in the ``template`` of the robot, or ``copies`` of files that lie here. What the command
prints, with its lines joined, holds each expression of ``says`` and none of ``never``; its ``status`` is 0 if not told.
"""

from __future__ import annotations

import re
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
import yaml
from click.testing import CliRunner

from kit.cli import main

FOLDER = Path(__file__).parent


@dataclass(frozen=True)
class Case:
    name: str
    shared: dict[str, Any]
    own: dict[str, Any]

    def write(self, folder: Path) -> None:
        """Writes what the command reads."""
        texts = dict(self.shared.get("files", {}))
        if "program" in self.own:
            texts["program.py"] = self.shared["before"] + self.own["program"]
        if "names" in self.own:
            text = self.shared["template"]
            for name, value in self.own["names"].items():
                text = text.replace(name, value)
            texts["bot.model.yaml"] = text
        for name, text in texts.items():
            (folder / name).write_text(text, encoding="utf-8")
        for name, source in self.own.get("copies", {}).items():
            shutil.copy(FOLDER / source, folder / name)


def cases() -> list[Case]:
    found = []
    for file in sorted(FOLDER.glob("*.yaml")):
        shared = yaml.safe_load(file.read_text(encoding="utf-8"))
        found += [Case(f"{file.stem}: {name}", shared, own) for name, own in shared["cases"].items()]
    return found


@pytest.mark.daily(4)
@pytest.mark.sampled(4)
@pytest.mark.parametrize("case", cases(), ids=lambda each: each.name)
def test_what_was_reported_elsewhere_is_right_here(
    case: Case, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    case.write(tmp_path)
    monkeypatch.chdir(tmp_path)
    result = CliRunner(env={"KIT_WORKSPACE": str(tmp_path / "workspace")}).invoke(main, case.shared["words"])
    output = " ".join(result.output.split())
    assert result.exit_code == case.own.get("status", 0), result.output
    for expression in case.own["says"]:
        assert re.search(expression, output), result.output
    for expression in case.own.get("never", ()):
        assert not re.search(expression, output), result.output


@pytest.mark.parametrize("file", sorted(FOLDER.glob("*.yaml")), ids=lambda each: each.stem)
def test_each_case_has_two_siblings(file: Path) -> None:
    assert len(yaml.safe_load(file.read_text(encoding="utf-8"))["cases"]) >= 3
