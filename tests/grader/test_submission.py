"""What may be handed in, and how."""

from __future__ import annotations

import io
import os
import tarfile
import zipfile
from pathlib import Path

import pytest

from grader.archives import MAX_BYTES, SubmissionRefused, unpack_archive
from grader.submission import read_submission


def zipped(entries: dict[str, bytes]) -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in entries.items():
            archive.writestr(name, content)
    return out.getvalue()


def tarred(entries: dict[str, bytes], mode: str = "w:gz") -> bytes:
    out = io.BytesIO()
    with tarfile.open(fileobj=out, mode=mode) as archive:  # type: ignore[call-overload]  # a mode by name
        for name, content in entries.items():
            entry = tarfile.TarInfo(name)
            entry.size = len(content)
            archive.addfile(entry, io.BytesIO(content))
    return out.getvalue()


def test_a_file_by_any_name_is_what_was_asked_for(tmp_path: Path) -> None:
    (tmp_path / "ada.py").write_bytes(b"x = 1")
    (tmp_path / "other.py").write_bytes(b"y = 1")
    taken = read_submission(tmp_path / "ada.py", "controller.py")
    assert taken.files == {"controller.py": b"x = 1"}
    with taken.in_temporary_folder() as file:
        assert file.read_bytes() == b"x = 1"
        assert [path.name for path in file.parent.iterdir()] == ["controller.py"]
    assert not file.exists()


@pytest.mark.parametrize("make", [zipped, tarred], ids=["zip", "tar"])
def test_an_archive_with_the_file_in_a_folder(tmp_path: Path, make: object) -> None:
    ending = "zip" if make is zipped else "tar.gz"
    path = tmp_path / f"ada.{ending}"
    content = {
        "work/controller.py": b"import friend",
        "work/friend.py": b"",
        "__MACOSX/x": b"",
        "notes.txt": b"n",
    }
    path.write_bytes(make(content))  # type: ignore[operator]  # one of the two
    taken = read_submission(path, "controller.py")
    assert taken.name == "ada"
    assert set(taken.files) == {"controller.py", "friend.py"}


def test_equal_content_has_an_equal_digest(tmp_path: Path) -> None:
    (tmp_path / "a.py").write_bytes(b"x = 1")
    folder = tmp_path / "b"
    folder.mkdir()
    (folder / "controller.py").write_bytes(b"x = 1")
    one, two = read_submission(tmp_path / "a.py", "controller.py"), read_submission(folder, "controller.py")
    assert one.digest == two.digest
    (folder / "controller.py").write_bytes(b"x = 2")
    assert read_submission(folder, "controller.py").digest != one.digest


def test_what_is_missing_or_twice_is_told(tmp_path: Path) -> None:
    folder = tmp_path / "a"
    folder.mkdir()
    (folder / "main.py").write_text("")
    with pytest.raises(SubmissionRefused, match=r"controller\.py is missing.*main\.py"):
        read_submission(folder, "controller.py")
    for each in ("one", "two"):
        (folder / each).mkdir()
        (folder / each / "controller.py").write_text("")
    with pytest.raises(SubmissionRefused, match="more than once"):
        read_submission(folder, "controller.py")


@pytest.mark.parametrize(
    "name",
    [
        "../x",
        "/etc/x",
        "a/../../x",
        "a//x",
        "C:\\x",
        "x\\y",
        "\u202ex",
        "a/b/c/d/e/f/g/x",
        ".hidden",
        "x.",
        "con\n",
    ],
)
def test_names_that_lead_elsewhere(name: str) -> None:
    with pytest.raises(SubmissionRefused):
        unpack_archive(tarred({name: b"x"}), "a.tar.gz")


@pytest.mark.parametrize("name", ["a.zip", "a.tar", "a.tar.gz"])
@pytest.mark.parametrize(
    "content",
    [b"", b"PK\x03\x04", b"not an archive" * 50, zipped({"a": b"x"})[:-30]],
    ids=["empty", "signature", "text", "cut off"],  # an archive holds the time: it is no name for a test
)
def test_damaged_archives(name: str, content: bytes) -> None:
    with pytest.raises(SubmissionRefused):
        unpack_archive(content, name)


def test_a_bomb_goes_off_in_nobodys_hands() -> None:
    with pytest.raises(SubmissionRefused, match="bomb"):
        unpack_archive(zipped({"a": bytes(MAX_BYTES * 4)}), "a.zip")
    with pytest.raises(SubmissionRefused, match="bomb"):
        unpack_archive(tarred({"a": bytes(MAX_BYTES * 4)}), "a.tar.gz")


@pytest.mark.parametrize("kind", ["link", "folder link", "pipe", "device"])
def test_only_plain_files(tmp_path: Path, kind: str) -> None:
    folder = tmp_path / "a"
    folder.mkdir()
    (folder / "controller.py").write_text("")
    if kind == "link":
        (folder / "x.py").symlink_to("/etc/passwd")
    elif kind == "folder link":
        (folder / "x").symlink_to("/etc")
    elif kind == "pipe":
        os.mkfifo(folder / "x.py")
    else:
        (folder / "x.py").symlink_to("/dev/zero")
    with pytest.raises(SubmissionRefused):
        read_submission(folder, "controller.py")
