"""Private folders are the owner's alone, and do not outlive it by more than one start."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from kit.host import private_folder as module
from kit.host.private_folder import make_private_folder, private_folder, remove_abandoned_folders

OWNER = """\
import sys, time
from kit.host.private_folder import make_private_folder
from pathlib import Path
folder = Path(make_private_folder())
(folder / "locked").mkdir()
(folder / "locked" / "file").write_text("left")
(folder / "locked").chmod(0)
print(folder, flush=True)
time.sleep(600)
"""


@pytest.fixture(autouse=True)
def temporary(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setattr(module, "_swept_folders", set())
    return tmp_path


def _owner(temporary: Path) -> tuple[subprocess.Popen[str], Path]:
    """A process that has made a folder and waits."""
    process = subprocess.Popen(
        [sys.executable, "-P", "-c", OWNER],
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "TMPDIR": str(temporary), "PYTHONPATH": os.pathsep.join(sys.path)},
    )
    assert process.stdout is not None
    return process, Path(process.stdout.readline().strip())


def test_only_its_owner_may_enter_it() -> None:
    with private_folder() as folder:
        assert folder.stat().st_mode & 0o777 == 0o700
        (folder / "file").write_text("text")
    assert not folder.exists()


def test_its_path_holds_in_every_current_folder(
    temporary: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Programs that are granted it stand elsewhere: with a relative TMPDIR none of them started."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(tempfile, "tempdir", ".")
    with private_folder() as folder:
        assert folder.is_absolute()


def test_the_next_start_removes_the_folder_of_a_killed_process_and_of_no_living_one(temporary: Path) -> None:
    killed, left = _owner(temporary)
    living, kept = _owner(temporary)
    try:
        os.kill(killed.pid, signal.SIGKILL)
        killed.wait()
        assert left.is_dir(), "nothing that had to be removed"
        own = Path(make_private_folder())
        assert not left.exists()
        assert kept.is_dir()
        assert own.is_dir()
    finally:
        for process in (killed, living):
            process.kill()
            process.wait()
            assert process.stdout is not None
            process.stdout.close()


def test_a_number_that_another_process_has_got_since_does_not_protect_a_folder(
    temporary: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = Path(make_private_folder())
    start_of = module._start_of_process
    monkeypatch.setattr(module, "_start_of_process", lambda pid: (start_of(pid) or 0) - 1)
    earlier = Path(make_private_folder())
    monkeypatch.undo()
    remove_abandoned_folders(str(temporary))
    assert own.is_dir()
    assert not earlier.exists()


def test_its_name_tells_no_process(temporary: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    name = Path(make_private_folder()).name
    assert str(os.getpid()) not in name.split("-")
    assert str(module._start_of_process(os.getpid())) not in name.split("-")
    monkeypatch.setattr(module, "_BOOT", b"another start of the machine")
    assert Path(make_private_folder()).name.split("-")[3] != name.split("-")[3], (
        "who knows no secret can compare nothing"
    )


def test_where_there_is_no_proc_a_name_says_the_process(
    temporary: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "_start_of_process", lambda pid: 0 if pid == os.getpid() else None)
    own = Path(make_private_folder())
    left = own.with_name(f"{module.PREFIX}{module._MACHINE}-p{2**22 + 1}-x")
    left.mkdir()
    remove_abandoned_folders(str(temporary))
    assert own.is_dir()
    assert not left.exists()


def test_folders_of_other_machines_and_other_names_stay(temporary: Path) -> None:
    """In a temporary folder that several containers share, a process id says nothing about another's processes."""
    pid = 2**22 + 1  # larger than any
    names = (f"{module.PREFIX}00000000-p{pid}-x", f"{module.PREFIX}of-mine", f"kit-{pid}")
    for name in names:
        (temporary / name).mkdir()
    (temporary / "target").mkdir()
    link = temporary / f"{module.PREFIX}{module._MACHINE}-p{pid}-link"
    link.symlink_to(temporary / "target")
    remove_abandoned_folders(str(temporary))
    assert all((temporary / name).is_dir() for name in names)
    assert link.is_symlink()
    assert (temporary / "target").is_dir()
