"""A new run's folder: whole, or not there."""

from __future__ import annotations

import errno
from pathlib import Path

import pytest

from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training import run_folders
from kit.learning.training.run_config import RunConfig
from kit.learning.training.run_folders import RunExists, create_run, list_runs
from kit.workspace import DRAFT_PREFIX

TURN = RunConfig(TaskSpec("turn"), "q-learning")


def test_names_are_numbered_and_one_that_was_asked_for_is_refused_when_taken(tmp_path: Path) -> None:
    assert [create_run(tmp_path, TURN).name for _ in range(3)] == [
        f"turn-q-learning-kit-0{ending}" for ending in ("", "-2", "-3")
    ]
    with pytest.raises(RunExists, match="kit train --resume turn-q-learning-kit-0-2"):
        create_run(tmp_path, TURN, "turn-q-learning-kit-0-2")
    assert len(list_runs(tmp_path)) == len(list(tmp_path.iterdir())) == 3


def test_a_full_disk_leaves_no_part_of_a_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def no_room(path: Path, data: bytes) -> None:
        raise OSError(errno.ENOSPC, "No space left on device", str(path))

    monkeypatch.setattr(run_folders, "write_atomically", no_room)
    with pytest.raises(OSError, match="No space left"):
        create_run(tmp_path, TURN, "mine")
    assert list(tmp_path.iterdir()) == []


def test_a_run_that_is_still_written_is_none_yet(tmp_path: Path) -> None:
    create_run(tmp_path, TURN, "mine").folder.rename(tmp_path / f"{DRAFT_PREFIX}x")
    assert list_runs(tmp_path) == ()
