"""The user's folder: made once, written whole or not at all."""

from __future__ import annotations

import os
import signal
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from kit.controllers import find_controller, prepare_workspace, user_controllers
from kit.workspace import (
    WorkspaceError,
    check_writable,
    draft_folder,
    expand_home,
    open_common_folder,
    open_workspace,
    write_atomically,
)


def test_the_folder_is_the_one_named_else_the_environments_else_in_the_home(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.delenv("KIT_WORKSPACE", raising=False)
    assert open_workspace().folder == tmp_path / "robot-kit"
    monkeypatch.setenv("KIT_WORKSPACE", "~/elsewhere")
    assert open_workspace().folder == tmp_path / "elsewhere"
    assert open_workspace(tmp_path / "named").folder == tmp_path / "named"
    assert (tmp_path / "named" / "controllers").is_dir()
    assert not open_workspace(tmp_path / "not made", make=False).folder.exists()


def test_a_place_that_cannot_be_a_folder_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(WorkspaceError, match="--workspace"):
        open_workspace(tmp_path / "file" / "below")
    monkeypatch.setenv("KIT_WORKSPACE", "~nobody-of-that-name/kit")
    with pytest.raises(WorkspaceError, match="home"):
        open_workspace(make=False)
    assert expand_home("~nobody-of-that-name/x") == Path("~nobody-of-that-name/x")


def test_a_file_is_written_whole_or_not_at_all(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "file"
    write_atomically(file, b"old")

    def full(handle: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match="No space left on device") as caught:
        write_atomically(file, b"new")
    assert caught.value.filename == str(file)
    assert file.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [file]


@pytest.mark.skipif(sys.platform != "linux", reason="files without a name are Linux's")
def test_a_kill_while_a_file_is_written_leaves_nothing_of_it(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_bytes(b"old")
    code = (
        "import os, signal, sys\n"
        "from pathlib import Path\n"
        "from kit.workspace import write_atomically\n"
        "os.fsync = lambda handle: os.kill(os.getpid(), signal.SIGKILL)\n"
        "write_atomically(Path(sys.argv[1]), b'new')\n"
    )
    killed = subprocess.run([sys.executable, "-c", code, str(file)], check=False)
    assert killed.returncode == -signal.SIGKILL
    assert file.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [file]


def test_a_folder_is_there_whole_or_not_at_all(tmp_path: Path) -> None:
    wanted = tmp_path / "hall"
    with draft_folder(tmp_path) as draft:
        (draft / "map.yaml").write_text("whole")
        assert not wanted.exists()
        (tmp_path / "other").mkdir()
        assert draft.stat().st_mode == (tmp_path / "other").stat().st_mode, (
            "readable as any folder of the user's"
        )
        (tmp_path / "other").rmdir()
        draft.rename(wanted)
    assert [path.name for path in wanted.iterdir()] == ["map.yaml"]
    with pytest.raises(KeyboardInterrupt):
        _fill_and_interrupt(tmp_path)
    assert list(tmp_path.iterdir()) == [wanted]


def _fill_and_interrupt(folder: Path) -> None:
    with draft_folder(folder) as draft:
        (draft / "map.yaml").write_text("ha")
        raise KeyboardInterrupt


def test_a_desk_on_a_full_disk_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(handle: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(WorkspaceError, match="No space left on device"):
        prepare_workspace(tmp_path)


def test_what_cannot_be_written_is_known_beforehand(tmp_path: Path) -> None:
    check_writable(tmp_path / "file")
    assert not list(tmp_path.iterdir())
    with pytest.raises(FileNotFoundError, match="below"):
        check_writable(tmp_path / "no folder" / "below")
    with pytest.raises(IsADirectoryError):
        check_writable(tmp_path)


@pytest.mark.timeout(20)
def test_only_files_are_controllers(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.py")
    (tmp_path / "folder.py").mkdir()
    (tmp_path / "gone.py").symlink_to(tmp_path / "nowhere")
    (tmp_path / "deep.py").write_text("x = " + "(" * 5000 + ")" * 5000)
    (tmp_path / "bytes.py").write_bytes(b"\xff\x00")
    assert [each.name for each in user_controllers(tmp_path)] == ["bytes", "deep"]
    with pytest.raises(LookupError):
        find_controller("pipe.py", tmp_path)


def test_a_link_stays_one_and_its_target_is_written(tmp_path: Path) -> None:
    (tmp_path / "there").mkdir()
    link = tmp_path / "link"
    link.symlink_to(tmp_path / "there" / "file")
    for content in (b"new", b"newer"):  # also where nothing is there yet
        write_atomically(link, content)
        assert link.is_symlink()
        assert (tmp_path / "there" / "file").read_bytes() == content
    assert [path.name for path in (tmp_path / "there").iterdir()] == ["file"]


def test_a_link_and_a_pipe_in_a_folder_of_several_users_are_replaced(tmp_path: Path) -> None:
    precious = tmp_path / "precious"
    precious.write_bytes(b"mine")
    link, pipe = tmp_path / "link", tmp_path / "pipe"
    link.symlink_to(precious)
    os.mkfifo(pipe)
    for file in (link, pipe):
        write_atomically(file, b"new", follows_links=False)
        assert stat.S_ISREG(file.lstat().st_mode)
        assert file.read_bytes() == b"new"
    assert precious.read_bytes() == b"mine"


def test_a_pipe_and_a_device_are_written_to_and_not_replaced(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    try:
        check_writable(pipe)
        write_atomically(pipe, b"through")
        assert os.read(reader, 100) == b"through"
    finally:
        os.close(reader)
    assert pipe.is_fifo()
    with (tmp_path / "out").open("wb") as out:
        code = "from pathlib import Path; from kit.workspace import *; write_atomically(Path('/dev/stdout'), b'two')"
        out.write(b"one ")
        out.flush()
        subprocess.run([sys.executable, "-c", code], stdout=out, check=True)
    assert (tmp_path / "out").read_bytes() == b"one two"


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can make somebody else's folder")
def test_a_common_folder_of_another_user_is_refused(tmp_path: Path) -> None:
    """Whoever owns it may remove what others put there, whatever its mode."""
    folder = tmp_path / "hall"
    assert open_common_folder(folder) == ""
    os.chown(folder, 65534, 65534)
    assert "belongs to another user" in open_common_folder(folder)
    os.chown(folder, 0, 0)
    assert open_common_folder(folder) == ""


def test_a_draft_that_cannot_be_made_blames_the_folder_and_not_its_own_hidden_name(tmp_path: Path) -> None:
    missing = tmp_path / "away"
    with pytest.raises(OSError, match="away") as found, draft_folder(missing):
        pass
    assert found.value.filename == str(missing)
