"""Student files, and limits that make accidents end quickly."""

from __future__ import annotations

import json
import sys
import textwrap
from pathlib import Path
from typing import Any, Protocol

import pytest

from kit.host import program_start
from kit.host.sandbox.limits import MIB, Limits


class Student(Protocol):
    """Writes a student's file and returns its path."""

    def __call__(self, source: str, name: str = "work.py") -> Path: ...


QUICK = Limits(start_s=20.0, reply_s=1.0, wall_factor=5.0, memory=600 * MIB, output=4096, frame=64 * 1024)
"""Short deadlines, but no shorter than a busy machine needs for honest code."""

LINUX = pytest.mark.skipif(sys.platform != "linux", reason="needs Linux's /proc")


_SPEAKER = """
import json, os, struct, sys
def hear():
    count, = struct.unpack(">I", os.read(0, 4))
    while count: count -= len(os.read(0, count))
def say(content):
    data = json.dumps(content).encode()
    data = struct.pack(">I", len(data)) + data
    while data: data = data[os.write(0, data):]
with open(sys.argv[1]) as file: steps = json.load(file)
for step in steps:
    hear() if step is None else say(step)
os.read(0, 1)
"""


class Speaker(Protocol):
    """Lets the next children say these frames, and hear one for each None, in place of the kit's own code."""

    def __call__(self, *steps: list[Any] | None) -> None: ...


@pytest.fixture
def speaker(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Speaker:
    program, frames = tmp_path / "speaker.py", tmp_path / "frames.json"
    program.write_text(_SPEAKER)

    def say(*steps: list[Any] | None) -> None:
        frames.write_text(json.dumps(steps))
        command = [sys.executable, "-S", str(program), str(frames)]
        monkeypatch.setattr(program_start, "interpreter_command", lambda: command)

    return say


@pytest.fixture
def student(tmp_path: Path) -> Student:
    folder = tmp_path / "student"
    folder.mkdir()

    def write(source: str, name: str = "work.py") -> Path:
        file = folder / name
        file.write_text(textwrap.dedent(source), encoding="utf-8")
        return file

    return write
