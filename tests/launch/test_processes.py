"""Commands of a launch, and how much of what they print is taken."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from kit.host.node_process import NodeProcess
from kit.launch.processes import MAX_LINE_LENGTH, MAX_READ, CommandProcess, NodeProgramProcess
from kit.ros.graph.graph import Graph
from tests.waiting import wait_until


@contextmanager
def command(*words: str) -> Iterator[CommandProcess]:
    process = CommandProcess(words, shell=False, environment=os.environ, cwd=Path.cwd())
    try:
        yield process
    finally:
        process.close()


def test_a_line_is_kept_up_to_its_limit_and_a_longer_one_says_that_it_is_cut() -> None:
    text = "".join(
        "x" * (MAX_LINE_LENGTH + more) + end for more, end in ((0, "\n"), (1, "\n"), (0, "\n"), (1, ""))
    )
    with command(sys.executable, "-c", f"print({text!r}, end='')") as process:
        wait_until(process.poll)
        lines = [line.text for line in process.take_lines()]
    assert [len(line) == MAX_LINE_LENGTH for line in lines] == [True, False, True, False]
    assert [line.endswith("bytes)") for line in lines] == [False, True, False, True]
    assert {line[:MAX_LINE_LENGTH] for line in lines} == {"x" * MAX_LINE_LENGTH}


def test_a_command_that_prints_without_end_is_read_a_part_at_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    parts = iter([b"y\n" * (1 << 15)] * 200)  # as ``yes`` fills a pipe while it is read
    with command("true") as process, monkeypatch.context() as patch:
        patch.setattr(os, "read", lambda descriptor, size: next(parts, b"")[:size])
        lines = process.take_lines()
    assert 2 * len(lines) <= 2 * MAX_READ  # two bytes a line, two streams


def test_a_program_that_is_ended_before_it_has_begun_may_still_be_asked(tmp_path: Path) -> None:
    file = tmp_path / "large.py"
    file.write_text(f"TEXT = {'x' * 200_000!r}\n")  # larger than what the pipe to it takes at once
    process = NodeProgramProcess(NodeProcess(Graph(log_sink=lambda record: None), file))
    assert process.poll() is None
    process.close()
    assert process.poll() is None
