"""The commit of the kit's source is asked for without running what a repository's settings name."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

from kit.study import kit_commit

PROGRAMS = ("core.fsmonitor", "filter.a.clean", "filter.a.process", "filter.a=b.clean", "core.hooksPath")
"""Settings of a repository that name a program, or a folder of programs."""


def git(folder: Path, *words: str) -> str:
    who = ("-c", "user.name=a", "-c", "user.email=a@example.org")
    names = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
    done = subprocess.run(["git", *who, *words], cwd=folder, env=names, capture_output=True, text=True)
    return done.stdout.strip()


@pytest.fixture
def source(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder in which the kit might lie, below one that is anybody's."""
    folder = tmp_path / "anybodys" / "source"
    (folder / "kit" / "study").mkdir(parents=True)
    module = folder / "kit" / "study" / "kit_commit.py"
    module.write_text("")
    monkeypatch.setattr(kit_commit, "__file__", str(module))
    monkeypatch.setattr(kit_commit, "SHIPPED_FOLDER", folder / "kit" / "study" / "results")
    return folder


def make_repository(folder: Path, marker: Path, setting: str) -> None:
    git(folder, "init", "-q")
    (folder / "kit").mkdir(exist_ok=True)
    (folder / ".gitattributes").write_text(f"*.txt filter={'a=b' if '=' in setting else 'a'}\n")
    (folder / "kit" / "a.txt").write_text("one\n")
    git(folder, "add", ".")
    git(folder, "commit", "-qm", "one")
    program = folder / ".git" / "programs" / "post-index-change"
    program.parent.mkdir()
    program.write_text(f"#!/bin/sh\ntouch '{marker}'\ncat\n")
    program.chmod(0o755)
    git(folder, "config", setting, str(program.parent if setting == "core.hooksPath" else program))
    (folder / "kit" / "a.txt").write_text("two\n")
    os.utime(folder / ".gitattributes", (1, 1))  # so that asking for the state writes the index, at any speed


@pytest.mark.parametrize("setting", PROGRAMS)
def test_a_repositorys_settings_run_nothing(source: Path, tmp_path: Path, setting: str) -> None:
    marker = tmp_path / "was run"
    make_repository(source, marker, setting)
    commit = kit_commit.kit_commit()
    assert commit == f"{git(source, 'rev-parse', '--short=12', 'HEAD')}+"
    assert not marker.exists()
    git(source, "status", "--porcelain")
    assert marker.exists(), "what is asked without this care runs it"


@pytest.mark.parametrize("by_variable", [False, True])
def test_a_repository_of_anybodys_is_not_asked(
    source: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, by_variable: bool
) -> None:
    make_repository(source.parent, tmp_path / "was run", "core.fsmonitor")
    (tmp_path / "was run").unlink(missing_ok=True)
    if by_variable:
        monkeypatch.setenv("GIT_DIR", str(source.parent / ".git"))
    assert kit_commit.kit_commit() == ""
    assert not (tmp_path / "was run").exists()
