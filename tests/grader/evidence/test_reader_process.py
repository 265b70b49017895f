"""What a reading process answers is taken up to its limit."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from grader.evidence import reader_process
from grader.evidence.reader_process import ReaderProcess
from kit.host.failure import Failure, FailureKind, StudentCodeError

ANSWERS = """
import sys
sys.stdout.write('"' + "x" * (int(sys.argv[-1]) - 3) + '"\\n')
sys.stdout.flush()
sys.stdin.read()
"""
SLOW = Failure(FailureKind.TIMEOUT, "slow")


@pytest.mark.parametrize("beyond", [0, 1])
def test_an_answer_is_taken_up_to_its_limit(
    beyond: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "answers.py").write_text(ANSWERS)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.setattr(reader_process, "MAX_ANSWER_BYTES", 1_000_000)
    began = time.monotonic()
    with ReaderProcess(
        "answers", tmp_path, subject="world", advice="Look at it", words=[str(1_000_000 + beyond)]
    ) as process:
        if not beyond:
            assert (
                len(process._await_line(began + 60.0, SLOW)) == 1_000_000 - 1
            )  # without the end of the line
            return
        with pytest.raises(StudentCodeError, match=r"more than 1 MB\. Look at it") as caught:
            process._await_line(began + 60.0, SLOW)
        assert caught.value.failure.kind is FailureKind.MEMORY
        assert process._child.poll() is not None
