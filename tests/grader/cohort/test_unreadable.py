"""A class survives what students send: bombs, readers that fail, secrets that are not used."""

from __future__ import annotations

import gzip
import io
import json
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from grader import submission as submission_module
from grader.__main__ import main
from grader.cohort.class_findings import MAX_LISTED, attention_blocks
from grader.cohort.gradebook import SAME_ERRORS, UNREADABLE, GradebookRow, gradebook_rows
from grader.cohort.queue import Queue, prepare_queue
from grader.grading import GradingOptions, grade
from grader.reading import read_assignment
from grader.submission import Submission
from grader.submitted_files import SubmissionUnreadable
from kit.document.layout import Page, lines_of
from kit.host.sandbox.sandbox_config import Level
from tests.grader.conftest import FORWARD, QUICK, write_assignment
from tests.grader.test_submission import nested_folders, zipped

TERMS = GradingOptions(Level.LIMITED, may_lower_level=False)
REWARD = """
title: Reward
kind: reward
submit: reward.py
level: 0
grid: {discount: 0.95, max_steps: 40, map: "#####\\n#...#\\n#..G#\\n#####"}
checks: [{check: contract, points: 1}]
"""
DRIVE = """
title: Drive
kind: drive
submit: drive.npz
level: 0
drive: {place: simple, case: simple, time: 60}
checks: [{check: genuine, points: 1}]
"""
MAX_MIB = 300
PREPARE = """
import json, resource, sys
from pathlib import Path
from grader.cohort.queue import Queue, prepare_queue
from grader.grading import GradingOptions, grade
from grader.reading import read_assignment
from kit.host.sandbox.sandbox_config import Level
resource.setrlimit(resource.RLIMIT_CPU, (60, 60))
assignment, cohort, queue = map(Path, sys.argv[1:])
entries = prepare_queue(Queue(queue), cohort, read_assignment(assignment), GradingOptions(Level.LIMITED))
peak = next(int(line.split()[1]) for line in open("/proc/self/status") if line.startswith("VmHWM")) // 1024
print(json.dumps([peak, {entry.name: entry.refused for entry in entries}]))
"""
"""What ``grader cohort`` does before it grades, and the most memory that it took [MiB].

Not ``ru_maxrss``: that begins at the size of the process that started this one.
"""


def header_bomb(path: Path, kind: bytes, size: int) -> None:
    """Writes a .tgz with one extended header of ``size`` zeros, without ever having them in memory."""
    entry = tarfile.TarInfo("././@LongLink")
    entry.type, entry.size = kind, size
    with gzip.open(path, "wb", 1) as out:
        out.write(entry.tobuf(tarfile.GNU_FORMAT))
        for _ in range(size >> 20):
            out.write(bytes(1 << 20))


def lzma_bomb(path: Path) -> None:
    """Writes a .zip whose file asks for a dictionary of 4 GB."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_LZMA) as archive:
        archive.writestr("reward.py", "def reward(reached): return 1.0\n" * 100)
    content = path.read_bytes()
    start = content.index(b"reward.py") + len("reward.py")
    path.write_bytes(content[: start + 5] + b"\xff\xff\xff\xff" + content[start + 9 :])


def directory_bomb(path: Path) -> None:
    """Writes a .zip that names a hundred thousand files."""
    with zipfile.ZipFile(path, "w") as archive:
        for number in range(100_000):
            archive.writestr(zipfile.ZipInfo(f"{number}.py"), b"")


def prepare_bombs(folder: Path) -> tuple[int, dict[str, str]]:
    """Prepares a class in which every bomb lies; returns the most memory that it took [MiB], and why each was refused."""
    write_assignment(folder / "sheet", REWARD)
    cohort = folder / "in"
    deep = cohort / "deep"
    deep.mkdir(parents=True)
    (deep / "reward.py").write_text("def reward(reached): return 1.0\n")
    for name, kind in (("pax", tarfile.XHDTYPE), ("longname", tarfile.GNUTYPE_LONGNAME)):
        header_bomb(cohort / f"{name}.tgz", kind, 400 << 20)
    header_bomb(cohort / "pdf.tgz", tarfile.XGLTYPE, 60_000)
    lzma_bomb(cohort / "dictionary.zip")
    directory_bomb(cohort / "directory.zip")
    (cohort / "zeros.zip").write_bytes(zipped({"reward.py": bytes(100 << 20)}))
    (cohort / "source.py").write_bytes(b"a," * (4 << 20))
    (cohort / "honest.py").write_text("def reward(reached): return 2.0\n")
    with nested_folders(deep, 1200):
        done = subprocess.run(
            [sys.executable, "-c", PREPARE, folder / "sheet", cohort, folder / "queue"],
            capture_output=True,
            text=True,
            check=False,
        )
    assert done.returncode == 0, done.stderr
    peak, refused = json.loads(done.stdout)
    return peak, refused


@pytest.mark.skipif(sys.platform != "linux", reason="the peak of a process's memory is in KiB on Linux alone")
@pytest.mark.long
def test_the_process_that_prepares_a_class_survives_every_bomb(tmp_path: Path) -> None:
    peak, refused = prepare_bombs(tmp_path)
    assert {name for name, why in refused.items() if not why} == {"deep", "honest", "source"}
    assert all("bomb" in refused[name] for name in ("pax", "longname", "zeros"))
    assert "compression method" in refused["dictionary"]
    assert "too many files" in refused["directory"]
    assert peak < MAX_MIB


def test_a_large_source_of_a_reward_is_not_parsed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    cohort = tmp_path / "in"
    cohort.mkdir()
    (cohort / "source.py").write_bytes(b"a," * (1 << 20))
    queue = Queue(tmp_path / "queue")
    prepare_queue(queue, cohort, read_assignment(write_assignment(tmp_path / "sheet", REWARD)), TERMS)
    monkeypatch.setattr("ast.parse", lambda *given: pytest.fail("it was parsed"))
    result = queue.run_job(*queue.waiting())
    assert result is not None
    assert (result.points, result.tests[0].status.value) == (0.0, "student_error")
    assert "larger than 128 KiB" in result.tests[0].rationale


@pytest.mark.parametrize("stage", ["preparing", "grading"])
@pytest.mark.parametrize("count", [SAME_ERRORS - 1, SAME_ERRORS])
def test_the_same_error_in_three_works_is_the_graders_fault(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, count: int, stage: str
) -> None:
    """Fewer are each the row of a student, without a grade."""
    cohort = tmp_path / "in"
    cohort.mkdir()
    for number in range(count):
        (cohort / f"s{number}.py").write_text(f"# {number}\n")
    if stage == "preparing":
        monkeypatch.setattr(submission_module, "_read_submission", failing)
    else:
        monkeypatch.setattr("grader.cohort.queue.grade_and_keep", failing_grade)
    queue = Queue(tmp_path / "queue")
    prepare_queue(queue, cohort, read_assignment(write_assignment(tmp_path / "sheet")), TERMS)
    for key in queue.waiting():
        assert queue.run_job(key) is None
    assert queue.waiting() == (), "it is not tried again and again"
    table = gradebook_rows(queue)
    is_fault = count >= SAME_ERRORS
    assert {row.verdict for row in table} == {"broken" if is_fault else "unreadable"}
    assert {(row.points, row.final) for row in table} == {(None, None)}
    assert all(("The grader's fault" in row.note) is is_fault for row in table)
    assert all("KeyError" in row.note for row in table)


def failing(path: Path, main: str) -> Submission:
    raise KeyError("inside")


def failing_grade(*given: object) -> None:
    raise SubmissionUnreadable("a.py cannot be read (KeyError).", "KeyError in grader/kinds/drive/kind.py:1")


def test_unreadable_work_is_listed_first_with_its_way_out(tmp_path: Path) -> None:
    """Only what is broken comes after it; what has a grade is not listed."""
    cohort = tmp_path / "in"
    cohort.mkdir()
    (cohort / "a.ada.py").write_text(FORWARD)
    (cohort / "j.doe_hw1.zip").write_bytes(zipped({"hw.7z": b"7z"}))
    (cohort / "j.smith.zip").write_bytes(zipped({"hw1.py": FORWARD.encode(), ".git/HEAD": b"x"}))
    folder = write_assignment(tmp_path / "sheet")
    queue = Queue(tmp_path / "queue")
    prepare_queue(queue, cohort, read_assignment(folder), TERMS)
    assert len(queue.waiting()) == 1, "equal works, whatever lies beside them"
    queue.record_loss(*queue.waiting())
    lines = lines_of(attention_blocks(gradebook_rows(queue)), Page(width=200))
    assert lines[0] == "3 have no grade and need your attention:"
    assert lines[1].startswith("  j.doe_hw1: unreadable. controller.py is missing.")
    assert "7-Zip archive: unpack it" in lines[1]
    assert [line.split(":")[0] for line in lines[2:]] == ["  a.ada", "  j.smith"]
    note = gradebook_rows(queue)[2].note
    assert "hw1.py was taken as controller.py. Ignored, because it is not needed: .git." in note


SECRETS = """
title: Drive on
submit: controller.py
level: 0
trials: [{name: turn, place: turn, time: 0.3, seeds: [1]}]
checks:
  - {check: runs, points: 1}
  - {check: moves, points: 3, seeds: secret}
  - {check: bumps, points: 2, after: moves}
"""


@pytest.mark.long
def test_secrets_that_are_not_used_are_said_and_cost_nothing(tmp_path: Path) -> None:
    cohort = tmp_path / "in"
    cohort.mkdir()
    (cohort / "ada.py").write_text(FORWARD)
    folder = write_assignment(tmp_path / "sheet", SECRETS, secret="seeds: {turn: [4611686018427387905]}")
    asked = ["cohort", str(cohort), "--assignment", str(folder), "--level", "0", "--executor", "none"]

    def graded(*more: str) -> tuple[Result, GradebookRow]:
        """Prepares the class by the command, grades it here, and has the command end it."""
        queue = Queue(tmp_path / f"queue{len(more)}")
        command = [*asked, *more, "--queue", str(queue.folder)]
        CliRunner().invoke(main, command)
        queue.run_job(*queue.waiting())
        return CliRunner().invoke(main, command), gradebook_rows(queue)[0]

    done, row = graded()
    assert done.exit_code == 0
    assert "WARNING" in done.stderr
    assert "--secret was not given" in done.stderr
    assert "5 of 6 points were not graded; nobody loses them." in done.stdout
    assert (row.verdict, row.final, row.max_points, set(row.tests)) == ("pass", 1.0, 1.0, {"runs"})
    done, row = graded("--secret")
    assert "--secret was not given" not in done.stderr
    assert "not judged" not in done.stdout
    assert (row.max_points, set(row.tests)) == (6.0, {"runs", "moves", "bumps"})


@pytest.mark.parametrize("shape", ["(9**9,", "(", "(1,\n 2", "[[" * 3000])
def test_a_recording_with_a_broken_header_is_the_students(tmp_path: Path, shape: str) -> None:
    """An array's header is parsed as Python, by several readers that each fail in their own way."""
    header = f"{{'descr': '|u1', 'fortran_order': False, 'shape': {shape}".encode()
    array = b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as archive:
        for name in ("header.npy", "poses.npy", "counts.npy"):
            archive.writestr(name, array)
    cohort = tmp_path / "in"
    cohort.mkdir()
    (cohort / "ada.npz").write_bytes(out.getvalue())
    queue = Queue(tmp_path / "queue")
    prepare_queue(queue, cohort, read_assignment(write_assignment(tmp_path / "sheet", DRIVE)), TERMS)
    result = queue.run_job(*queue.waiting())
    assert result is not None
    assert result.tests[0].status.value == "student_error"
    assert "not a recording of the kit, or damaged" in result.tests[0].rationale


def test_a_recording_that_no_reader_expects_has_no_grade(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(task: object, file: Path) -> None:
        raise MemoryError

    monkeypatch.setattr("grader.kinds.drive.kind._load_checked", fail)
    cohort = tmp_path / "in"
    cohort.mkdir()
    (cohort / "ada.npz").write_bytes(b"x")
    queue = Queue(tmp_path / "queue")
    prepare_queue(queue, cohort, read_assignment(write_assignment(tmp_path / "sheet", DRIVE)), TERMS)
    assert queue.run_job(*queue.waiting()) is None
    (row,) = gradebook_rows(queue)
    assert (row.verdict, row.final) == ("unreadable", None)
    assert "cannot be read (MemoryError)" in row.note


def test_an_error_that_a_program_brings_to_light_is_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Else whoever finds such an error gets no grade instead of none of the points, and is told that it is no fault."""

    def stumble(*_: object, **__: object) -> None:
        raise OverflowError("ours")

    monkeypatch.setattr("grader.driving.episodes.run_episode", stumble)
    assignment = read_assignment(write_assignment(tmp_path / "quick", QUICK))
    work = Submission("ada", "controller.py", {"controller.py": FORWARD.encode()})
    with pytest.raises(SubmissionUnreadable, match="OverflowError"):
        grade(assignment, work, TERMS)


def test_of_many_works_that_need_attention_the_first_are_listed() -> None:
    def rows(count: int) -> list[GradebookRow]:
        return [
            GradebookRow(f"s{number:03}", UNREADABLE, None, 1.0, 1.0, None, {}, {}, "damaged", "a.py")
            for number in range(count)
        ]

    assert len(attention_blocks(rows(MAX_LISTED))) == 1 + MAX_LISTED
    head, *lines, last = lines_of(attention_blocks(rows(MAX_LISTED + 1)))
    assert head == f"{MAX_LISTED + 1} have no grade and need your attention:"
    assert [line.split(":")[0].strip() for line in lines] == [each.name for each in rows(MAX_LISTED)]
    assert last == "  and 1 more: see the gradebook"
