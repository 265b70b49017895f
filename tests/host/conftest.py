"""Student files, and limits that make accidents end quickly."""

from __future__ import annotations

import sys
import textwrap
from pathlib import Path
from typing import Protocol

import pytest

from kit.host.sandbox.limits import MIB, Limits


class Student(Protocol):
    """Writes a student's file and returns its path."""

    def __call__(self, source: str, name: str = "work.py") -> Path: ...


QUICK = Limits(start_s=20.0, reply_s=1.0, memory=600 * MIB, output=4096, frame=64 * 1024)
"""Short deadlines, but no shorter than a busy machine needs for honest code."""

LINUX = pytest.mark.skipif(sys.platform != "linux", reason="needs Linux's /proc")


@pytest.fixture
def student(tmp_path: Path) -> Student:
    folder = tmp_path / "student"
    folder.mkdir()

    def write(source: str, name: str = "work.py") -> Path:
        file = folder / name
        file.write_text(textwrap.dedent(source), encoding="utf-8")
        return file

    return write
