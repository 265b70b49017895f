"""One process holds a lock; who only looks keeps nobody out."""

from __future__ import annotations

import fcntl
import threading
from pathlib import Path

import pytest

from kit.learning.training.process_lock import LockedError, is_locked, process_lock


def test_one_holds_it_until_it_is_done(tmp_path: Path) -> None:
    file = tmp_path / "lock"
    assert not is_locked(file)
    with process_lock(file) as lock:
        lock.write(b"4711")
        lock.flush()
        assert is_locked(file)
        assert file.read_bytes() == b"4711"
        with pytest.raises(LockedError), process_lock(file):
            pass
        assert is_locked(file)
    assert not is_locked(file)


def test_it_is_taken_though_somebody_looks(tmp_path: Path) -> None:
    file = tmp_path / "lock"
    with file.open("ab") as look:
        fcntl.flock(look, fcntl.LOCK_SH)
        threading.Timer(0.05, fcntl.flock, (look, fcntl.LOCK_UN)).start()
        with process_lock(file):
            assert is_locked(file)
