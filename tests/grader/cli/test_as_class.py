"""A student's own check says at which confinement level it ran, and runs as a class is graded where that is asked."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from grader.__main__ import main
from kit.host.sandbox import probe
from kit.host.sandbox.confinement import Level
from tests.grader.conftest import LOCKS, write_assignment

BLANK = """
title: One word
kind: function
submit: half.py
level: 0
functions: [{name: half}]
checks: [{check: agrees, points: 1}]
"""
REFERENCE = """
def half(x): return x / 2
def half_cases(random): yield {"x": random.random()}
"""


def check(folder: Path, *arguments: str) -> Result:
    task = write_assignment(folder / "task", BLANK)
    (task / "reference.py").write_text(REFERENCE)
    work = folder / "half.py"
    work.write_text("def half(x): return x / 2\n")
    return CliRunner().invoke(main, ["check", str(work), "--assignment", str(task), *arguments])


def test_an_own_check_says_its_level_and_the_classs(tmp_path: Path) -> None:
    done = check(tmp_path)
    assert done.exit_code == 0
    text = " ".join(done.output.split())
    assert "Run at confinement level 0." in text
    assert "--as-class" in text


@LOCKS
def test_as_class_is_at_least_level_1(tmp_path: Path) -> None:
    done = check(tmp_path, "--as-class", "--json")
    assert done.exit_code == 0
    result = json.loads(done.stdout)
    assert result["level"] == 1
    assert not any("--as-class" in notice for notice in result["notices"])


def test_as_class_is_never_lowered(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(probe, "_known_levels", set())
    monkeypatch.setattr(probe, "is_level_available", lambda level: level is Level.LIMITED)
    done = check(tmp_path, "--as-class")
    assert done.exit_code == 2
    assert "does not reach confinement level 1" in done.output


def test_as_class_and_a_level_contradict(tmp_path: Path) -> None:
    assert check(tmp_path, "--as-class", "--level", "0").exit_code == 2


def test_secrets_that_are_not_used_are_named_and_cost_nothing(tmp_path: Path) -> None:
    (tmp_path / "task").mkdir()
    (tmp_path / "task" / "secret.yaml").write_text("seed: 4611686018427387905\n")
    done = check(tmp_path, "--json")
    assert "--secret was not given" in done.stderr
    assert json.loads(done.stdout)["verdict"] == "pass"
    assert "--secret" not in check(tmp_path, "--secret", "--level", "0", "--json").stderr
