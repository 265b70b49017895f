"""What people reported elsewhere, made anew: each ``NN_name.yaml`` has the case and its siblings, with what is right of each.

``words`` are those of a command of the kit, or of ``grader``, which is run in a folder with the ``files`` after the commands in
``first``; a case adds its ``program``, which comes after ``before``, its ``names`` in the ``template`` of the robot, or
``copies`` of files that lie here; its ``words``, ``files`` and ``environment`` take the place of the shared ones. What the
command prints, with its lines joined, holds each expression of ``says`` and none of ``never``; its ``status`` is 0 if not
told. Where the ``output`` is a file, the command writes to that one, and what it says is on standard error.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
import yaml
from click.testing import CliRunner

from grader.__main__ import main as grader_main
from kit.cli import main as kit_main

FOLDER = Path(__file__).parent
REPOSITORY = FOLDER.parents[1]


@dataclass(frozen=True)
class Case:
    name: str
    shared: dict[str, Any]
    own: dict[str, Any]

    def write(self, folder: Path) -> None:
        """Writes what the command reads."""
        texts = {**self.shared.get("files", {}), **self.own.get("files", {})}
        if "program" in self.own:
            texts["program.py"] = self.shared["before"] + self.own["program"]
        if "names" in self.own:
            text = self.shared["template"]
            for name, value in self.own["names"].items():
                text = text.replace(name, value)
            texts["bot.model.yaml"] = text
        for name, text in texts.items():
            (folder / name).parent.mkdir(exist_ok=True)
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
    environment = {"KIT_WORKSPACE": str(tmp_path / "workspace"), **case.own.get("environment", {})}
    for words in case.shared.get("first", ()):
        status, output = run(words, environment)
        assert status == 0, output
    target = case.shared.get("output")
    status, output = run(case.own.get("words", case.shared.get("words")), environment, target)
    assert status == case.own.get("status", 0), output
    joined = " ".join(output.split())
    for expression in case.own["says"]:
        assert re.search(expression, joined), output
    for expression in case.own.get("never", ()):
        assert not re.search(expression, joined), output


def run(words: Sequence[str], environment: dict[str, str], target: str | None = None) -> tuple[int, str]:
    """Runs a command; returns its exit status and what it prints; what it says on standard error, if it prints to ``target``."""
    is_grader = words[0] == "grader"
    if target is None:
        main = grader_main if is_grader else kit_main
        result = CliRunner(env=environment).invoke(main, list(words[is_grader:]))
        return result.exit_code, result.output
    with Path(target).open("wb") as opened:
        done = subprocess.run(
            [sys.executable, "-m", *([] if is_grader else ["kit"]), *words],
            stdout=opened,
            stderr=subprocess.PIPE,
            env={**os.environ, **environment, "PYTHONPATH": str(REPOSITORY)},
            timeout=120,
            check=False,
        )
    return done.returncode, done.stderr.decode()


@pytest.mark.parametrize("file", sorted(FOLDER.glob("*.yaml")), ids=lambda each: each.stem)
def test_each_case_has_two_siblings(file: Path) -> None:
    assert len(yaml.safe_load(file.read_text(encoding="utf-8"))["cases"]) >= 3
