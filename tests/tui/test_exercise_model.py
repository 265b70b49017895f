"""An exercise on the bench: any of its files that is saved has it checked; one that a moment brings does not."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

import pytest

from kit.tui.exercise_model import FolderWatch


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "maps").mkdir()
    for name in ("world.yaml", "maps/hall.yaml"):
        (tmp_path / name).write_text("as it was")
    return tmp_path


@pytest.fixture
def noticed(folder: Path) -> Callable[[], bool]:
    """Whether a save is noticed within a little while."""
    watch = FolderWatch(folder / "world.yaml")

    def look() -> bool:
        end = time.monotonic() + 1.5
        while time.monotonic() < end:
            if watch.has_changed():
                return True
            time.sleep(0.02)
        return False

    return look


@pytest.mark.long
def test_each_file_counts(folder: Path, noticed: Callable[[], bool]) -> None:
    for name in ("world.yaml", "maps/hall.yaml"):
        (folder / name).write_text("mended, and longer")
        assert noticed(), name
    assert not noticed()


@pytest.mark.long
def test_what_editors_and_checks_leave_does_not(folder: Path, noticed: Callable[[], bool]) -> None:
    (folder / "__pycache__").mkdir()
    for name in (".world.yaml.swp", ".worst.npz", "world.yaml~", "__pycache__/x.pyc", "4913"):
        (folder / name).write_text("for a moment")
    assert not noticed()


@pytest.mark.long
def test_a_new_file_counts_from_its_next_save_on(folder: Path, noticed: Callable[[], bool]) -> None:
    (folder / "pen.dat").write_text("0 0 1 1")
    assert not noticed()
    (folder / "pen.dat").write_text("0 0 1 1, and more")
    assert noticed()


@pytest.mark.long
def test_a_folder_that_goes_away_is_no_save(folder: Path, noticed: Callable[[], bool]) -> None:
    (folder / "maps" / "hall.yaml").unlink()
    (folder / "maps").rmdir()
    assert not noticed()
