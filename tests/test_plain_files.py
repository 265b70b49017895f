"""Files of other people: a pipe or a device never holds a reader, and no file is read beyond its limit."""

from __future__ import annotations

import io
import os
import subprocess
import sys
import textwrap
import warnings
import zipfile
from collections.abc import Callable
from contextlib import nullcontext, suppress
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from grader.kinds.policy.kind import load_submitted_policy
from grader.submission import read_submission
from grader.submitted_files import SubmissionRefused
from kit.array_archives import MAX_UNPACKED_BYTES, unpack_arrays
from kit.cli.replay import command as replay
from kit.learning.policies.policy import PolicyError
from kit.learning.policies.policy_file import load_policy
from kit.learning.tasks.learning_task import UnknownTask
from kit.learning.tasks.task_reader import read_task
from kit.learning.training.demonstrations import is_recording
from kit.plain_files import open_plain_file, read_plain_file
from kit.run.recording import RecordingError, load_recording
from kit.school.progress import ProgressError
from kit.school.progress_export import read_export
from kit.school.report.class_data import read_roster
from kit.world.loading import load_world
from kit.world.problems import WorldError

READERS: dict[str, Callable[[Path], object]] = {
    "x.npz": load_recording,
    "policy.npz": load_policy,
    "submitted.npz": load_submitted_policy,
    "demonstration.npz": is_recording,
    "export.json": read_export,
    "roster.json": lambda file: read_roster([file]),
    "world.yaml": load_world,
    "task.yaml": read_task,
    "work.py": lambda file: read_submission(file, "work.py"),
    "plain": lambda file: read_plain_file(file, 100),
}
REFUSALS = (OSError, RecordingError, PolicyError, ProgressError, WorldError, UnknownTask, SubmissionRefused)


@pytest.mark.parametrize("name", READERS)
@pytest.mark.parametrize("kind", ["pipe", "device", "folder"])
def test_what_is_no_plain_file_never_holds_a_reader(name: str, kind: str, tmp_path: Path) -> None:
    """``/dev/zero`` would fill the memory, a pipe wait for ever."""
    file = tmp_path / name
    if kind == "pipe":
        os.mkfifo(file)
    elif kind == "folder":
        file.mkdir()
    else:
        file.symlink_to("/dev/zero")
    with suppress(*REFUSALS):
        READERS[name](file)


def test_a_pipe_would_hold_a_reader_that_does_not_look(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(subprocess.TimeoutExpired):
        subprocess.run([sys.executable, "-c", f"open({str(tmp_path / 'pipe')!r})"], timeout=0.5, check=False)


def test_a_link_is_followed_only_where_that_is_wanted(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("x")
    (tmp_path / "link").symlink_to("file")
    with open_plain_file(tmp_path / "link") as opened:
        assert opened.read() == b"x"
    with pytest.raises(OSError, match="symbolic"):
        open_plain_file(tmp_path / "link", follows_links=False)


def test_a_file_is_read_up_to_its_limit(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(bytes(100))
    assert len(read_plain_file(tmp_path / "file", 100)) == 100
    with pytest.raises(OSError, match="larger than"):
        read_plain_file(tmp_path / "file", 99)


def bomb(names: tuple[str, ...]) -> bytes:
    """A small archive whose arrays unpack to more than may be read."""
    made = io.BytesIO()
    head = io.BytesIO()
    count = MAX_UNPACKED_BYTES // 8 // len(names) + 1
    np.lib.format.write_array_header_1_0(head, {"descr": "<f8", "fortran_order": False, "shape": (count,)})
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in names:
            with archive.open(f"{name}.npy", "w", force_zip64=True) as member:
                member.write(head.getvalue())
                for _ in range(count * 8 // (1 << 20) + 1):
                    member.write(bytes(1 << 20))
    return made.getvalue()


@pytest.mark.long
@pytest.mark.parametrize("reader", ["load_recording", "load_policy"])
def test_an_archive_that_unpacks_to_far_more_takes_no_memory(reader: str, tmp_path: Path) -> None:
    file = tmp_path / "bomb.npz"
    file.write_bytes(bomb(("header", "poses", "counts", "about")))
    assert file.stat().st_size < 2_000_000
    source = f"""
        import resource
        from kit.learning.policies.policy import PolicyError; from kit.learning.policies.policy_file import load_policy
        from kit.run.recording import load_recording, RecordingError
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        try: {reader}({str(file)!r})
        except (RecordingError, PolicyError) as error: print(error)
        print("grown by", (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) // 1024)
    """
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(source)],
        capture_output=True,
        text=True,
        check=True,
        timeout=100,
    )
    assert "larger than" in done.stdout
    assert int(done.stdout.rpartition(" ")[2]) < 50, "MiB"


@pytest.mark.parametrize(("shape", "is_read"), [("(3,)", True), ("(3L,)", False)])
def test_an_array_as_python_2_wrote_it_is_refused_without_a_warning(shape: str, is_read: bool) -> None:
    """numpy reads it, and warns whoever merely opens somebody else's file."""
    header = f"{{'descr': '<i8', 'fortran_order': False, 'shape': {shape}, }}".ljust(117).encode() + b"\n"
    array = b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header + bytes(24)
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w") as archive:
        archive.writestr("counts.npy", array)
    with warnings.catch_warnings(), nullcontext() if is_read else pytest.raises(SyntaxError):
        warnings.simplefilter("error")
        assert list(unpack_arrays(made.getvalue(), 1000)["counts"]) == [0, 0, 0]


def recorded_in(place: str, folder: Path) -> Path:
    """A recording of one tick that says that it was made in this place."""
    header = f'{{"format": 1, "place": "{place}", "case": null, "seed": 1, "step_size": 0.01, "models": [], "inputs": [], "level": null}}'
    arrays = {"poses": np.zeros((0, 3)), "counts": np.zeros(1, dtype=np.int64)}
    np.savez(folder / "r.npz", header=np.frombuffer(header.encode(), dtype=np.uint8), **arrays)
    return folder / "r.npz"


def test_a_recording_names_no_file_elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("recorded", "current", "elsewhere"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "secret.yaml").write_text("answer: forty-two\n")
    monkeypatch.chdir(tmp_path / "current")
    elsewhere = tmp_path / "elsewhere"
    for place, is_read in (
        ("/etc/passwd", False),
        (f"{elsewhere}/secret.yaml", False),
        ("../elsewhere/secret.yaml", False),
        (f"{tmp_path}/recorded/secret.yaml", True),
        ("secret.yaml", True),
    ):
        file = recorded_in(place, tmp_path / "recorded")
        done = CliRunner().invoke(replay, [str(file), "--check"])
        assert done.exit_code == 2
        assert ("answer" in done.output) == is_read, done.output
        assert ("--root" in done.output) == (not is_read), done.output
    file = recorded_in(f"{elsewhere}/secret.yaml", tmp_path / "recorded")
    assert "answer" in CliRunner().invoke(replay, [str(file), "--check", "--root", str(elsewhere)]).output
