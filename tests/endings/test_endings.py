"""A share of ``python -m tests.endings``: what is recorded is kept, whatever ends its program."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.endings.endings import can_mount, try_ending

pytestmark = [
    pytest.mark.long,
    pytest.mark.timeout(300),
    pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="processes are read in /proc"),
]


@pytest.mark.parametrize(
    ("recorder", "ending"),
    [
        ("run --record", "SIGTERM"),
        ("run --record", "SIGKILL"),
        ("run --record", "second"),
        ("run --bag", "full out"),
        ("run --bag sqlite3", "SIGKILL"),
        ("ros bag record", "SIGHUP"),
        ("ros bag record", "partner"),
        ("maps new", "SIGKILL"),
        ("run --bag", "closed pipe"),
    ],
)
def test_what_is_recorded_is_kept(tmp_path: Path, recorder: str, ending: str) -> None:
    result = try_ending(recorder, ending, tmp_path)
    assert result.is_right, result


@pytest.mark.skipif(not can_mount(), reason="only the superuser may make a small file system")
@pytest.mark.parametrize("recorder", ["run --record", "run --bag"])
def test_a_full_disk_is_said_and_nothing_lost(tmp_path: Path, recorder: str) -> None:
    result = try_ending(recorder, "full disk", tmp_path)
    assert result.is_right, result
    assert "once" in result.text


@pytest.mark.skipif(not can_mount(), reason="only the superuser may make a small file system")
@pytest.mark.parametrize("recorder", ["run --record", "ros bag record", "train"])
def test_a_folder_that_can_only_be_read_is_named(tmp_path: Path, recorder: str) -> None:
    result = try_ending(recorder, "read only", tmp_path)
    assert result.is_right, result
    assert "Read-only" in result.text
