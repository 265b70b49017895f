"""A file of lines after a program was killed while it wrote, and on a full disk."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from kit.line_log import LineLog


@pytest.mark.parametrize("half", [b"", b"thr", b'{"a": 1}'])
def test_no_line_is_joined_to_half_a_line(tmp_path: Path, half: bytes) -> None:
    file = tmp_path / "log"
    file.write_bytes(b"one\ntwo\n" + half)
    with file.open("a+b") as opened:
        log = LineLog(opened)
        assert log.was_cut == bool(half)
        log.append(b"four")
        assert file.read_bytes() == b"one\ntwo\nfour\n", "at once, and not when it is closed"


def test_on_a_full_disk_nothing_of_a_line_is_left(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file, write = tmp_path / "log", os.write
    with file.open("a+b") as opened:
        log = LineLog(opened)
        log.append(b"one")

        def fill(handle: int, content: bytes) -> int:
            if len(content) < 4:
                raise OSError(28, "No space left on device")
            return write(handle, content[:3])

        monkeypatch.setattr(os, "write", fill)
        with pytest.raises(OSError, match="No space"):
            log.append(b"three")
        assert file.read_bytes() == b"one\n"
        monkeypatch.undo()
        log.append(b"two")
    assert file.read_bytes() == b"one\ntwo\n"
