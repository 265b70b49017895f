"""An assignment's own Python, which may be a stranger's, reads Python and its folder, and reaches nothing else."""

from __future__ import annotations

import contextlib
import os
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from grader.author_code import AuthorCodeError, run_author_code
from grader.grading import GradingOptions, grade
from grader.reading import read_assignment
from grader.submission import Submission
from kit.host.sandbox.sandbox_config import Level
from kit.host.wire import Json
from kit.results.grading_result import CriterionStatus
from tests.grader.conftest import FORWARD, LOCKS
from tests.grader.teacher_tests.test_running import OWN, folder_with

pytestmark = pytest.mark.skipif(not LOCKS, reason="this machine has no level 1")

LIMIT_S = 60.0


def attempts(private: Path, inside: Path, port: int) -> dict[str, Callable[[], Json]]:
    """What a stranger's reference could do with its reader's rights; each returns what it has got."""
    return {
        "reads a file": lambda: private.read_text(),
        "writes a file": lambda: (private.with_name("new").write_text("x"), "wrote")[1],
        "changes a file": lambda: (private.chmod(0o777), "changed")[1],
        "starts a program": lambda: subprocess.run([sys.executable, "-c", ""], check=True).returncode,
        "forks": lambda: os.fork(),
        "connects": lambda: connect(port),
        "signals": lambda: os.kill(os.getppid(), 0) or "signalled",
        "reads the environment": lambda: os.environ["A_TOKEN"],
        "reads its parent's environment": lambda: Path(f"/proc/{os.getppid()}/environ").read_text(),
        "reads what is open": lambda: os.read(next(iter(OPEN)), 100).decode(),
        "reads standard input": lambda: os.read(0, 100).decode() or None,
    }


def connect(port: int) -> int:
    with socket.create_connection(("127.0.0.1", port), 1) as connection:
        return connection.fileno()


OPEN: list[int] = []
NAMES = list(attempts(Path(), Path(), 0))


@pytest.mark.parametrize("name", NAMES)
def test_it_reaches_nothing(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """And at level 0, which somebody has asked for, it does: the control."""
    private, folder = tmp_path / "private" / "letter", tmp_path / "sheet"
    private.parent.mkdir()
    folder.mkdir()
    private.write_text("of nobody's concern")
    monkeypatch.setenv("A_TOKEN", "secret")
    with socket.create_server(("127.0.0.1", 0)) as server, private.open("rb") as opened:
        OPEN[:] = [opened.fileno()]
        attempt = attempts(private, folder, server.getsockname()[1])[name]

        def attack() -> Json:
            try:
                return attempt()
            except (OSError, KeyError, subprocess.SubprocessError):
                return None

        assert run_author_code(attack, folder, Level.FILTERED, LIMIT_S) is None
        if name not in ("forks", "reads standard input", "reads its parent's environment"):
            assert attack() is not None
    assert not private.with_name("new").exists() or name == "writes a file"


def test_what_it_returns_and_raises_comes_back(tmp_path: Path) -> None:
    (tmp_path / "table.txt").write_text("7")
    told = run_author_code(
        lambda: [int((tmp_path / "table.txt").read_text()), 0.5], tmp_path, Level.FILTERED, 9
    )
    assert told == [7, 0.5]
    with pytest.raises(AuthorCodeError, match="ZeroDivisionError"):
        run_author_code(lambda: 1 / 0, tmp_path, Level.FILTERED, LIMIT_S)
    with pytest.raises(AuthorCodeError, match="before its last answer"):
        run_author_code(lambda: os._exit(0), tmp_path, Level.FILTERED, LIMIT_S)
    with pytest.raises(AuthorCodeError, match="more than 64 MB"):
        run_author_code(lambda: "x" * 65_000_000, tmp_path, Level.FILTERED, LIMIT_S)


@pytest.mark.parametrize(
    "answer", [b"", b"7", b"[1]", b'{"value"', b'{"error": []}', b"[" * 100_000, b"\xff", b"null"]
)
def test_what_it_writes_itself_is_no_error_of_the_graders(answer: bytes, tmp_path: Path) -> None:
    """It has the pipe open, and may write what it likes."""

    def forge() -> Json:
        for descriptor in range(3, 64):
            with contextlib.suppress(OSError):
                os.write(descriptor, answer)
        os._exit(0)

    with pytest.raises(AuthorCodeError):
        run_author_code(forge, tmp_path, Level.FILTERED, LIMIT_S)


@pytest.mark.parametrize("value", [7, [], [7], [[["x"]]], {"a": 1}, None])
def test_a_reference_that_answers_nonsense_costs_no_student_a_point(
    value: Json, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "assignment.yaml").write_text(
        "title: T\nkind: function\nsubmit: work.py\nfunctions: [{name: f}]\nchecks: [{check: agrees, points: 1}]\n"
    )
    (tmp_path / "reference.py").write_text("def f(x): return x\ndef f_cases(chance): yield {'x': 1}\n")
    monkeypatch.setattr("grader.kinds.function.kind.run_author_code", lambda *given: value)
    work = Submission("ada", "work.py", {"work.py": b"def f(x): return x\n"})
    result = grade(read_assignment(tmp_path), work, GradingOptions(Level.FILTERED))
    assert result.tests[0].status is CriterionStatus.GRADER_ERROR


def test_what_goes_on_is_ended(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    fork, started = os.fork, []

    def noted_fork() -> int:
        process = fork()
        started.append(process)
        return process

    monkeypatch.setattr(os, "fork", noted_fork)
    with pytest.raises(AuthorCodeError, match="longer than"):
        run_author_code(lambda: time.sleep(3600), tmp_path, Level.FILTERED, 0.3)
    (process,) = started
    with pytest.raises(ProcessLookupError):
        os.kill(process, 0)


def test_another_thread_of_the_grader_does_not_stop_it(tmp_path: Path) -> None:
    stop = threading.Event()
    thread = threading.Thread(target=stop.wait)
    thread.start()
    try:
        assert run_author_code(lambda: 1, tmp_path, Level.FILTERED, LIMIT_S) == 1
    finally:
        stop.set()
        thread.join()


@pytest.mark.long
def test_tests_of_a_strangers_sheet_reach_nothing(tmp_path: Path) -> None:
    """They earn what they earn at level 0, and what they want beyond that is refused."""
    letter = tmp_path / "letter"
    letter.write_text("of nobody's concern")
    own = OWN + (
        "\n@pytest.mark.points(1)\ndef test_reads_a_letter(grading):\n"
        f"    assert open({str(letter)!r}).read()\n"
        "\n@pytest.mark.points(1)\ndef test_in_its_own_place(grading, tmp_path):\n"
        "    (tmp_path / 'note').write_text('x')\n"
    )
    folder = folder_with(tmp_path, own)
    work = Submission("ada", "controller.py", {"controller.py": FORWARD.encode()})
    desk, confined = (
        {
            test.id: (test.status, test.points)
            for test in grade(read_assignment(folder), work, GradingOptions(level)).tests
        }
        for level in (Level.LIMITED, Level.FILTERED)
    )
    assert desk["test_reads_a_letter"] == (CriterionStatus.PASS, 1.0)
    assert confined.pop("test_reads_a_letter")[0] is CriterionStatus.GRADER_ERROR
    assert confined == {name: each for name, each in desk.items() if name != "test_reads_a_letter"}


def test_reading_a_sheet_runs_nothing_of_it(tmp_path: Path) -> None:
    marker = tmp_path / "ran"
    folder = tmp_path / "sheet"
    folder.mkdir()
    (folder / "assignment.yaml").write_text(
        "title: T\nkind: function\nsubmit: work.py\nfunctions: [{name: f}]\nchecks: [{check: agrees, points: 1}]\n"
    )
    (folder / "reference.py").write_text(
        f"open({str(marker)!r}, 'w')\ndef f(x): return x\ndef f_cases(chance): yield {{'x': 1}}\n"
    )
    assignment = read_assignment(folder)
    assert not marker.exists()
    work = Submission("ada", "work.py", {"work.py": b"def f(x): return x\n"})
    result = grade(assignment, work, GradingOptions(Level.FILTERED))
    assert not marker.exists()
    assert result.tests[0].status is CriterionStatus.GRADER_ERROR
