"""Another user of the machine reads nothing of a workspace or a queue, whatever the umask is.

The other user is made and removed by the test, which needs root; the modes are checked without it as well.
"""

from __future__ import annotations

import os
import shutil
import stat
import subprocess
import tempfile
import uuid
from collections.abc import Iterator
from pathlib import Path

import pytest

from grader.assignment import Assignment
from grader.cohort.queue import Queue, prepare_queue
from grader.grading import GradingOptions
from grader.reading import read_assignment
from kit.host.sandbox.sandbox_config import Level
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.run_config import RunConfig
from kit.learning.training.run_folders import create_run
from kit.school.progress import EventKind, ProgressJournal
from kit.workspace import make_private_folder, open_workspace, write_atomically
from tests.grader.conftest import FORWARD, write_assignment

TERMS = GradingOptions(Level.LIMITED, may_lower_level=False)


@pytest.fixture
def open_place() -> Iterator[Path]:
    """A folder that everybody may enter, under the most careless umask but one."""
    before = os.umask(0o022)
    folder = Path(tempfile.mkdtemp())
    folder.chmod(0o755)
    try:
        yield folder
    finally:
        os.umask(before)
        shutil.rmtree(folder)


@pytest.fixture
def neighbour() -> Iterator[str]:
    """Another user of this machine."""
    if os.geteuid() != 0 or shutil.which("useradd") is None:
        pytest.skip("making another user needs root and useradd")
    name = f"kit-{uuid.uuid4().hex[:8]}"
    subprocess.run(
        ["useradd", "--no-create-home", "--shell", "/bin/sh", name], check=True, capture_output=True
    )
    try:
        yield name
    finally:
        subprocess.run(["userdel", name], check=True, capture_output=True)


def seen_by(user: str, folder: Path) -> str:
    """What a user can list and read below a folder."""
    look = 'find "$0" -exec sh -c \'echo "$1"; [ ! -f "$1" ] || cat "$1"\' sh {} ";" 2>/dev/null'
    run = subprocess.run(
        ["sh", "-c", look, str(folder)],
        cwd="/",  # `find` does not go on where it may not return to
        user=user,
        group=user,
        extra_groups=[],
        capture_output=True,
        check=False,
    )
    return run.stdout.decode(errors="replace")


def full_workspace(folder: Path) -> None:
    """A workspace with progress, a program and a training run."""
    workspace = open_workspace(folder)
    (workspace.controllers / "mine.py").write_text("# a confidential program\n")
    with ProgressJournal(workspace.folder) as journal:
        journal.add(EventKind.STEP, "confidential")
    create_run(workspace.runs, RunConfig(TaskSpec("turn"), "q-learning", seed=1))


def full_queue(folder: Path, assignment: Assignment, hand_ins: Path) -> None:
    """A queue with a graded work."""
    queue = Queue(folder)
    prepare_queue(queue, hand_ins, assignment, TERMS)
    for key in queue.waiting():
        queue.run_job(key)
    write_atomically(queue.folder / "gradebook.csv", b"confidential,3\n")


def test_a_neighbour_reads_no_workspace(open_place: Path, neighbour: str) -> None:
    (open_place / "public.txt").write_text("for everybody")
    full_workspace(open_place / "robot-kit")
    assert "for everybody" in seen_by(neighbour, open_place)  # the control
    seen = seen_by(neighbour, open_place / "robot-kit")
    assert "confidential" not in seen
    assert "progress.db" not in seen


def test_a_neighbour_reads_no_progress_in_a_folder_that_was_there(open_place: Path, neighbour: str) -> None:
    (open_place / "home").mkdir()
    (open_place / "home" / "note.txt").write_text("for everybody")
    full_workspace(open_place / "home")
    seen = seen_by(neighbour, open_place / "home")
    assert "for everybody" in seen  # what was there keeps its mode
    assert "confidential" not in seen


@pytest.mark.long
def test_a_neighbour_reads_no_queue(open_place: Path, neighbour: str, tmp_path: Path) -> None:
    assignment = read_assignment(write_assignment(tmp_path / "quick"))
    hand_ins = tmp_path / "in"
    hand_ins.mkdir()
    (hand_ins / "confidential.py").write_text(FORWARD)
    full_queue(open_place / "queue", assignment, hand_ins)
    assert seen_by(neighbour, open_place / "queue").splitlines() == [str(open_place / "queue")]


def test_folders_are_their_owners_alone(open_place: Path) -> None:
    full_workspace(open_place / "robot-kit")
    for folder in (open_place / "robot-kit", *(open_place / "robot-kit").iterdir()):
        if folder.is_dir():
            assert stat.S_IMODE(folder.stat().st_mode) == 0o700, folder
    assert stat.S_IMODE((open_place / "robot-kit" / "progress.db").stat().st_mode) == 0o600


def test_a_workspace_and_a_queue_that_are_open_are_closed(open_place: Path, tmp_path: Path) -> None:
    for name in ("robot-kit", "queue"):
        (open_place / name).mkdir(mode=0o755)
    full_workspace(open_place / "robot-kit")
    (open_place / "robot-kit").chmod(0o755)
    (open_place / "robot-kit" / "progress.db").chmod(0o644)
    ProgressJournal(open_workspace(open_place / "robot-kit").folder).close()
    hand_ins = tmp_path / "in"
    hand_ins.mkdir()
    prepare_queue(
        Queue(open_place / "queue"), hand_ins, read_assignment(write_assignment(tmp_path / "quick")), TERMS
    )
    for name, mode in (
        ("robot-kit", 0o700),
        ("robot-kit/progress.db", 0o600),
        ("queue", 0o700),
        ("queue/jobs", 0o700),
    ):
        assert stat.S_IMODE((open_place / name).stat().st_mode) == mode, name


def test_folders_of_everybody_and_homes_stay_as_they_are(
    open_place: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (open_place / "shared").mkdir()
    (open_place / "shared").chmod(0o1777)
    (open_place / "home").mkdir()
    monkeypatch.setenv("HOME", str(open_place / "home"))
    for name, mode in (("shared", 0o1777), ("home", 0o755), (".", 0o755)):
        make_private_folder(open_place / name)
        assert stat.S_IMODE((open_place / name).stat().st_mode) == mode, name
    (open_place / "site").mkdir()
    (open_place / "site" / "index.html").touch()
    open_workspace(open_place / "site")
    assert stat.S_IMODE((open_place / "site").stat().st_mode) == 0o755
    assert stat.S_IMODE((open_place / "site" / "controllers").stat().st_mode) == 0o700
    (open_place / "file").touch()
    with pytest.raises(FileExistsError):
        make_private_folder(open_place / "file")


@pytest.mark.parametrize(("umask", "mode"), [(0o022, 0o644), (0o077, 0o600), (0o027, 0o640)])
def test_a_file_has_the_mode_of_the_umask_and_keeps_its_own(open_place: Path, umask: int, mode: int) -> None:
    os.umask(umask)
    file = open_place / "export.json"
    write_atomically(file, b"new")
    assert stat.S_IMODE(file.stat().st_mode) == mode
    file.chmod(0o604)
    write_atomically(file, b"newer")
    assert (stat.S_IMODE(file.stat().st_mode), file.read_bytes()) == (0o604, b"newer")
