"""What may be handed in, and how."""

from __future__ import annotations

import bz2
import gzip
import io
import lzma
import os
import shutil
import tarfile
import time
import zipfile
import zlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from grader import submission as submission_module
from grader.archives import streams
from grader.archives.streams import MAX_COMPRESSION_RATIO
from grader.archives.tar_archive import MAX_HEADER_BYTES, _pax_values
from grader.archives.zip_archive import MAX_DIRECTORY_BYTES
from grader.shown_names import is_plain_name
from grader.submission import MAX_NAMED, Submission, read_submission
from grader.submitted_files import (
    MAX_BYTES,
    MAX_ENTRIES,
    MAX_FILES,
    SubmissionRefused,
    SubmissionUnreadable,
    SubmittedFiles,
    reading_submission,
)
from tests.grader.attack import write_tar
from tests.grader.packed import zipped


def tarred(entries: dict[str, bytes], mode: str = "w:gz") -> bytes:
    out = io.BytesIO()
    with tarfile.open(fileobj=out, mode=mode) as archive:  # type: ignore[call-overload]  # a mode by name
        for name, content in entries.items():
            entry = tarfile.TarInfo(name)
            entry.size = len(content)
            archive.addfile(entry, io.BytesIO(content))
    return out.getvalue()


def unpack_archive(content: bytes, name: str, folder: Path, main: str = "controller.py") -> Submission:
    """Reads these bytes as an archive of this name."""
    (folder / name).write_bytes(content)
    return read_submission(folder / name, main)


def test_a_file_by_any_name_is_what_was_asked_for(tmp_path: Path) -> None:
    (tmp_path / "ada.py").write_bytes(b"x = 1")
    (tmp_path / "other.py").write_bytes(b"y = 1")
    taken = read_submission(tmp_path / "ada.py", "controller.py")
    assert taken.files == {"controller.py": b"x = 1"}
    with taken.in_temporary_folder() as file:
        assert file.read_bytes() == b"x = 1"
        assert [path.name for path in file.parent.iterdir()] == ["controller.py"]
    assert not file.exists()


@pytest.mark.parametrize("inside", ["work/", "./", "./work/"])
@pytest.mark.parametrize("make", [zipped, tarred], ids=["zip", "tar"])
def test_an_archive_with_the_file_in_a_folder(tmp_path: Path, make: object, inside: str) -> None:
    ending = "zip" if make is zipped else "tar.gz"
    path = tmp_path / f"ada.{ending}"
    content = {
        f"{inside}controller.py": b"import friend",
        f"{inside}friend.py": b"",
        "__MACOSX/x": b"",
        "notes.txt": b"n",
    }
    path.write_bytes(make(content))  # type: ignore[operator]  # one of the two
    taken = read_submission(path, "controller.py")
    assert taken.name == "ada"
    beside = {"notes.txt"} if inside == "./" else set()  # what lies outside of the work's folder is left out
    assert set(taken.files) == {"controller.py", "friend.py"} | beside


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
    (folder / "main.py").write_text("x = 1")
    (folder / "other.py").write_text("x = 1")
    with pytest.raises(
        SubmissionRefused, match=r"controller\.py is missing.*main\.py.*Give your program the name"
    ):
        read_submission(folder, "controller.py")
    for each in ("one", "two"):
        (folder / each).mkdir()
        (folder / each / "controller.py").write_text("x = 1")
    with pytest.raises(SubmissionRefused, match="more than once"):
        read_submission(folder, "controller.py")


@pytest.mark.parametrize("make", [zipped, tarred], ids=["zip", "tar"])
@pytest.mark.parametrize("name", ["../x", "/etc/x", "a/../../x", "C:\\x", "..\\x", ".git/../../x"])
def test_names_that_lead_elsewhere(name: str, make: object, tmp_path: Path) -> None:
    ending = "zip" if make is zipped else "tar.gz"
    content = make({"controller.py": b"x = 1", name: b"x"})  # type: ignore[operator]  # one of the two
    with pytest.raises(SubmissionRefused, match="leads out of the folder"):
        unpack_archive(content, f"a.{ending}", tmp_path)


@pytest.mark.parametrize("name", ["a//x", "x\\y", "\u202ex", ".hidden", "x.", "con\n", "a/b/c/d/e/f/g/x"])
def test_a_name_that_nothing_needs_is_ignored_and_named(name: str, tmp_path: Path) -> None:
    taken = unpack_archive(tarred({"controller.py": b"x = 1", name: b"x"}), "a.tar.gz", tmp_path)
    assert set(taken.files) == {"controller.py"}
    assert taken.note.startswith("Ignored, because it is not needed: ")
    assert taken.note.isprintable()


def test_a_note_names_the_first_files_that_were_ignored(tmp_path: Path) -> None:
    for count, end in ((MAX_NAMED, "."), (MAX_NAMED + 1, " and 1 more.")):
        hidden = {f".hidden{number}": b"x" for number in range(count)}
        taken = unpack_archive(tarred({"controller.py": b"x = 1", **hidden}), "a.tar.gz", tmp_path)
        named = ", ".join(sorted(hidden)[:MAX_NAMED])
        assert taken.note == f"Ignored, because it is not needed: {named}{end}"


UNNEEDED = (
    *(
        ".gitignore",
        ".gitattributes",
        ".github/workflows/x.yml",
        ".vscode/settings.json",
        ".idea/x",
        ".git/HEAD",
    ),
    *("__MACOSX/._controller.py", "._controller.py", ".DS_Store", "__pycache__/x.pyc", "venv/lib/x.py"),
    *(".venv/lib/x.py", "env/pyvenv.cfg", "env/lib/x.py", "Übung 1 – Bericht.pdf", "Foto.JPG", "Übung.csv"),
)


@pytest.mark.long_cases("tar.gz", "zip")
@pytest.mark.parametrize("where", ["zip", "tar.gz", "tar.xz", "tar.bz2", "folder"])
def test_what_is_not_needed_is_ignored_and_named(where: str, tmp_path: Path) -> None:
    content = dict.fromkeys(UNNEEDED, b"x" * 100) | {"controller.py": b"x = 1", "friend.py": b"y = 1"}
    if where in ("zip", "folder", "tar.gz"):
        content["video.mp4"] = os.urandom(MAX_BYTES // 8) * 9  # larger than all needed files may be
    if where == "zip":
        taken = unpack_archive(zipped(content), "a.zip", tmp_path)
    elif where == "folder":
        for name, data in content.items():
            (tmp_path / "a" / name).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / "a" / name).write_bytes(data)
        (tmp_path / "a" / "venv" / "python").symlink_to("/usr/bin/python3")
        taken = read_submission(tmp_path / "a", "controller.py")
    else:
        mode = f"w:{where.removeprefix('tar.')}"
        taken = unpack_archive(tarred(content, mode), f"a.{where}", tmp_path)
    kept = {"env/lib/x.py"} if where.startswith("tar") else set()  # its mark may come after it
    assert set(taken.files) - kept == {"controller.py", "friend.py"} | (
        {"env/pyvenv.cfg"} if where.startswith("tar") else set()
    )
    assert ".github" in taken.note
    assert " more." in taken.note
    alone = Submission("a", "controller.py", {"controller.py": b"x = 1", "friend.py": b"y = 1"})
    assert kept or taken.digest == alone.digest, "it is graded as if it were not there"


def test_a_lone_program_may_have_any_name_in_an_archive_too(tmp_path: Path) -> None:
    for name in ("Controller.py", "Übung 1/Übung 1 – Lösung.py", "hw1.py"):
        content = {name: b"x = 1", "data.csv": b"1,2", "report.pdf": b"%PDF"}
        taken = unpack_archive(zipped(content), "a.zip", tmp_path)
        assert taken.files["controller.py"] == b"x = 1"
        assert "was taken as controller.py" in taken.note
    taken = unpack_archive(zipped({"w.yml": b"a: 1", "map.png": b"\x89PNG"}), "a.zip", tmp_path, "world.yaml")
    assert set(taken.files) == {"world.yaml", "map.png"}


@pytest.mark.parametrize(
    ("handed", "name"),
    [
        ("j.doe_hw1.zip", "j.doe_hw1"),
        ("j.smith.ZIP", "j.smith"),
        ("a.b.tar.gz", "a.b"),
        ("v1.2.tgz", "v1.2"),
        ("x.tar.xz", "x"),
        ("j.doe.py", "j.doe"),
    ],
)
def test_names_keep_their_dots(handed: str, name: str, tmp_path: Path) -> None:
    assert submission_module.submission_name(tmp_path / handed) == name


NOTEBOOK = b'{"cells": [], "metadata": {}, "nbformat": 4}'


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("a.7z", b"7z\xbc\xaf\x27\x1c" + bytes(60), ("7-Zip", "unpack it")),
        ("a.rar", b"Rar!\x1a\x07\x01\x00", ("RAR", "unpack it")),
        ("a.zip", b"Rar!\x1a\x07\x01\x00", ("RAR", "whatever its name says")),
        ("a.ipynb", NOTEBOOK, ("notebook", "Executable Script")),
        ("a.py", NOTEBOOK, ("notebook", "Executable Script")),
        ("a.zip", zipped({"hw.ipynb": NOTEBOOK}), ("controller.py is missing", "notebook", "Executable Script")),
        ("a.zip", zipped({"controller.py": NOTEBOOK}), ("notebook", "Executable Script")),
        ("a.zip", zipped({"inner.zip": b"PK"}), ("controller.py is missing", "unpack it")),
        ("a.py", "x = 1".encode("utf-16"), ("UTF-16", "UTF-8")),
        ("a.py", "x = 1\n".encode("utf-16-le"), ("UTF-16", "UTF-8")),
        ("a.py", b"", ("empty", "save your work")),
        ("a.py", b" \n", ("empty", "save your work")),
        ("a.zip", b"", ("empty", "pack your work")),
        ("a.py", zipped({"x": b"x"}), ("zip archive", "unpack it")),
        ("a.pdf", b"%PDF-1.7", ("a PDF", "program itself")),
    ],
)  # fmt: skip
def test_a_wrong_format_is_called_by_its_name(
    name: str, content: bytes, words: tuple[str, ...], tmp_path: Path
) -> None:
    with pytest.raises(SubmissionRefused) as refused:
        unpack_archive(content, name, tmp_path)
    assert not isinstance(refused.value, SubmissionUnreadable)
    assert [word for word in words if word not in str(refused.value)] == []


@pytest.mark.parametrize("name", ["a.zip", "a.tar", "a.tar.gz", "a.tar.xz"])
@pytest.mark.parametrize(
    "content",
    [b"", b"PK\x03\x04", b"not an archive" * 50, zipped({"a": b"x"})[:-30], tarred({"a": b"x"})[:60],
     tarred({"a": os.urandom(5000)}, "w:xz")[:-60], tarred({"a": b"x" * 600}, "w:")[:900]],
    ids=["empty", "signature", "text", "cut off", "cut off gz", "cut off xz", "cut off tar"],
)  # fmt: skip
def test_damaged_archives(name: str, content: bytes, tmp_path: Path) -> None:
    with pytest.raises(SubmissionRefused) as refused:
        unpack_archive(content, name, tmp_path)
    assert not isinstance(refused.value, SubmissionUnreadable)


@pytest.mark.long
def test_a_bomb_goes_off_in_nobodys_hands(tmp_path: Path) -> None:
    for content, name in (
        (zipped({"a": bytes(MAX_BYTES * 4)}), "a.zip"),
        (tarred({"a": bytes(MAX_BYTES * 4)}), "a.tar.gz"),
        (tarred({"a.pdf": bytes(MAX_BYTES * 4)}), "b.tar.gz"),
        (tarred({"a": bytes(MAX_BYTES * 4)}, "w:bz2"), "a.tar.bz2"),
        (tarred({"a": bytes(MAX_BYTES * 4)}, "w:xz"), "a.tar.xz"),
    ):
        with pytest.raises(SubmissionRefused, match="bomb"):
            unpack_archive(content, name, tmp_path)


def test_long_names_of_an_archive_are_read(tmp_path: Path) -> None:
    """A path in an extended header, as GNU tar and as POSIX write it, with other marks beside it."""
    folder = "a" * 99 + "/" + "b" * 90
    for style in (tarfile.GNU_FORMAT, tarfile.PAX_FORMAT):
        out = io.BytesIO()
        with tarfile.open(fileobj=out, mode="w:gz", format=style, pax_headers={"comment": "x"}) as archive:
            for name in ("controller.py", "friend.py"):
                entry = tarfile.TarInfo(f"./{folder}/{name}")
                entry.size, entry.mtime = 5, 0.5 if style == tarfile.PAX_FORMAT else 0
                archive.addfile(entry, io.BytesIO(b"x = 1"))
        taken = unpack_archive(out.getvalue(), "a.tgz", tmp_path)
        assert dict(taken.files) == {"controller.py": b"x = 1", "friend.py": b"x = 1"}


@pytest.mark.parametrize(
    "kind", [tarfile.XHDTYPE, tarfile.XGLTYPE, tarfile.GNUTYPE_LONGNAME, tarfile.GNUTYPE_LONGLINK]
)
def test_a_large_header_is_refused_before_it_is_read(kind: bytes, tmp_path: Path) -> None:
    """Its content is not even there: that it was cut off would be said if it had been read."""
    entry = tarfile.TarInfo("header")
    entry.type, entry.size = kind, MAX_HEADER_BYTES + 1
    with pytest.raises(SubmissionRefused, match="bomb"):
        unpack_archive(entry.tobuf(tarfile.GNU_FORMAT), "a.tar", tmp_path)


def test_an_archive_larger_than_may_be_handed_in_is_not_unpacked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    content = zipped({"controller.py": b"x = 1", "video.mp4": os.urandom(40_000)})
    assert unpack_archive(content, "a.zip", tmp_path).files == {"controller.py": b"x = 1"}
    monkeypatch.setattr(submission_module, "MAX_PACKED_BYTES", 30_000)
    with pytest.raises(SubmissionRefused):
        unpack_archive(content, "a.zip", tmp_path)


def test_what_is_passed_over_in_a_compressed_archive_counts_too(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    content = tarred({"controller.py": b"x = 1", "video.mp4": os.urandom(200_000)})
    assert unpack_archive(content, "a.tgz", tmp_path).files == {"controller.py": b"x = 1"}
    monkeypatch.setattr(streams, "MAX_UNPACKED_BYTES", 150_000)
    with pytest.raises(SubmissionRefused, match="bomb"):
        unpack_archive(content, "a.tgz", tmp_path)


def test_what_unpacks_to_hundreds_of_its_size_is_a_bomb(tmp_path: Path) -> None:
    content = tarred({"controller.py": b"x = 1", "video.mp4": bytes(200_000)})
    assert len(content) * MAX_COMPRESSION_RATIO < 200_000
    with pytest.raises(SubmissionRefused, match="bomb"):
        unpack_archive(content, "a.tgz", tmp_path)


def test_a_directory_without_end_is_not_read(tmp_path: Path) -> None:
    names = {f"{number:02}" + "n" * 60_000: b"" for number in range(MAX_DIRECTORY_BYTES // 60_000 + 1)}
    with pytest.raises(SubmissionRefused, match="far too many files"):
        unpack_archive(zipped({"controller.py": b"x = 1"} | names), "a.zip", tmp_path)


def with_dictionary(packed: bytes, size: int) -> bytes:
    """An xz archive whose header asks for a dictionary of that size, a power of 2 [bytes], for the same content."""
    header = bytearray(packed[12 : 12 + 4 * (packed[12] + 1)])
    assert header[2:4] == b"\x21\x01"  # LZMA2, and one byte for its dictionary
    header[4] = 2 * (size.bit_length() - 13)
    header[-4:] = zlib.crc32(header[:-4]).to_bytes(4, "little")
    return packed[:12] + header + packed[12 + len(header) :]


def test_unpacking_takes_no_more_memory_than_xz_at_its_best(tmp_path: Path) -> None:
    packed = tarred({"controller.py": b"x = 1"}, "w:xz")
    best = with_dictionary(packed, 64 << 20)
    assert unpack_archive(best, "a.tar.xz", tmp_path).files == {"controller.py": b"x = 1"}
    with pytest.raises(SubmissionRefused, match="damaged"):
        unpack_archive(with_dictionary(packed, 128 << 20), "a.tar.xz", tmp_path)


def test_more_files_than_a_program_has_are_refused(tmp_path: Path) -> None:
    names = {f"part_{number}.py": b"x = 1" for number in range(MAX_FILES - 1)}
    assert (
        len(unpack_archive(zipped(names | {"controller.py": b"x = 1"}), "a.zip", tmp_path).files) == MAX_FILES
    )
    with pytest.raises(SubmissionRefused, match=str(MAX_FILES)):
        unpack_archive(zipped(names | {"controller.py": b"x = 1", "more.py": b"x = 1"}), "a.zip", tmp_path)


@pytest.mark.long
def test_too_many_entries_are_refused(tmp_path: Path) -> None:
    names = {f".git/{number}": b"" for number in range(MAX_ENTRIES + 1)}
    with pytest.raises(SubmissionRefused, match="without the folders"):
        unpack_archive(zipped(names | {"controller.py": b"x = 1"}), "a.zip", tmp_path)


@contextmanager
def nested_folders(folder: Path, depth: int) -> Iterator[None]:
    """Makes folders inside one another, one by one: a path of that length could not be given at once."""
    here = os.open(folder, os.O_RDONLY)
    for _ in range(depth):
        os.mkdir("d", dir_fd=here)
        inner = os.open("d", os.O_RDONLY, dir_fd=here)
        os.close(here)
        here = inner
    try:
        yield
    finally:
        for _ in range(depth):
            outer = os.open("..", os.O_RDONLY, dir_fd=here)
            os.close(here)
            here = outer
            os.rmdir("d", dir_fd=here)
        os.close(here)


@pytest.mark.long
def test_folders_without_end_are_not_entered(tmp_path: Path) -> None:
    folder = tmp_path / "ada"
    folder.mkdir()
    (folder / "controller.py").write_text("x = 1")
    with nested_folders(folder, 1200):
        taken = read_submission(folder, "controller.py")
    assert set(taken.files) == {"controller.py"}
    assert "d/d/d/d/d/..." in taken.note


@pytest.mark.parametrize("error", [RecursionError, MemoryError, KeyError, AssertionError])
def test_an_error_while_reading_is_the_submissions(
    error: type[Exception], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(path: Path, main: str) -> Submission:
        raise error("inside")

    monkeypatch.setattr(submission_module, "_read_submission", fail)
    with pytest.raises(SubmissionUnreadable, match=error.__name__) as raised:
        read_submission(tmp_path / "ada.py", "controller.py")
    assert raised.value.error.startswith(f"{error.__name__} in ")
    assert (
        "tests/grader/test_submission.py:" in raised.value.error
        or "grader/submission.py:" in raised.value.error
    )


def test_expected_errors_of_a_reader_stay_what_they_are() -> None:
    with pytest.raises(LookupError), reading_submission("a.py", LookupError):
        raise KeyError("x")
    with pytest.raises(SubmissionRefused, match="no"), reading_submission("a.py"):
        raise SubmissionRefused("no")


@pytest.mark.parametrize("name", ["x y.py", "a/b-1.py", "x(1).py"])
def test_plain_names(name: str) -> None:
    assert is_plain_name(name)
    for other in (f"{name}.", f" {name}", f"ü{name}", f"{name}\n", f"{name}//x"):
        assert not is_plain_name(other)


@pytest.mark.parametrize("kind", ["link", "folder link", "pipe", "device"])
def test_only_plain_files(tmp_path: Path, kind: str) -> None:
    folder = tmp_path / "a"
    folder.mkdir()
    (folder / "controller.py").write_text("x = 1")
    assert read_submission(folder, "controller.py").files
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


@pytest.mark.parametrize("what", ["folder", "file"])
def test_a_name_exchanged_for_a_link_while_it_is_read_leads_nowhere(
    what: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whoever may write in the folder of a hand-in sees by inotify when it is read."""
    secrets, work = tmp_path / "secrets", tmp_path / "work"
    for folder in (secrets, work / "inner"):
        folder.mkdir(parents=True)
    (secrets / "notes.txt").write_text("seeds: [40302]")
    (work / "controller.py").write_text("x = 1\n")
    (work / "inner" / "notes.txt").write_text("mine")
    needs = SubmittedFiles.needs

    def exchanging(files: SubmittedFiles, path: str, *, is_folder: bool = False) -> bool:
        needed = needs(files, path, is_folder=is_folder)
        if path == ("inner" if what == "folder" else "inner/notes.txt"):
            victim = work / path
            victim.rename(tmp_path / "seen")
            victim.symlink_to(secrets if what == "folder" else secrets / "notes.txt")
        return needed

    monkeypatch.setattr(SubmittedFiles, "needs", exchanging)
    with pytest.raises(SubmissionRefused, match="link"):
        read_submission(work, "controller.py")
    assert (work / "inner" / "notes.txt").read_text() == "seeds: [40302]", "by its path it does lead there"


def test_a_header_of_very_many_records_is_refused_at_once(tmp_path: Path) -> None:
    """Where what follows a record was copied for each of them, such headers took 50 s of processor time a megabyte."""
    record = b"5 a=\n"
    header = tarfile.TarInfo("header")
    header.type, header.size = tarfile.XHDTYPE, 13_000 * len(record)
    with tarfile.open(tmp_path / "a.tar", "w") as archive:
        for _ in range(200):
            archive.addfile(header, io.BytesIO(record * 13_000))
        archive.addfile(tarfile.TarInfo("controller.py"), io.BytesIO())
    began = time.process_time()
    with pytest.raises(SubmissionRefused, match="more than a program needs"):
        read_submission(tmp_path / "a.tar", "controller.py")
    assert time.process_time() - began < 0.5


def _many_files(path: Path) -> None:
    with zipfile.ZipFile(path, "w") as archive:
        for number in range(30_000):
            archive.writestr(f"{number}.pdf", b"")


def _long_paths(path: Path) -> None:
    with tarfile.open(path, "w") as archive:
        for number in range(100):
            archive.addfile(tarfile.TarInfo(f"{'a/' * 30_000}{number}"), io.BytesIO())


MANY = {"files.zip": _many_files, "paths.tar": _long_paths}


@pytest.mark.long
@pytest.mark.parametrize("name", MANY)
def test_time_grows_with_what_is_handed_in_and_not_with_its_square(name: str, tmp_path: Path) -> None:
    """By the square, it is ten seconds or more."""
    MANY[name](tmp_path / name)
    began = time.process_time()
    with pytest.raises(SubmissionRefused, match="is missing"):
        read_submission(tmp_path / name, "controller.py")
    assert time.process_time() - began < 4


@pytest.mark.parametrize("compress", [gzip.compress, bz2.compress, lzma.compress])
def test_a_file_of_very_many_empty_streams_is_a_bomb(
    compress: Callable[[bytes], bytes], tmp_path: Path
) -> None:
    write_tar(tmp_path / "plain.tar", "controller.py", tarfile.REGTYPE)
    packed = compress((tmp_path / "plain.tar").read_bytes())
    (tmp_path / "few.tgz").write_bytes(compress(b"") * 5 + packed)
    with pytest.raises(SubmissionRefused, match="empty"):
        read_submission(tmp_path / "few.tgz", "controller.py")
    (tmp_path / "many.tgz").write_bytes(compress(b"") * 20_000 + packed)
    with pytest.raises(SubmissionRefused, match="more than a program needs"):
        read_submission(tmp_path / "many.tgz", "controller.py")


def test_records_of_extended_headers_are_read_where_they_lie() -> None:
    path, size = _pax_values(b"12 path=a/b\n10 size=7\n30 comment=" + b"x" * 18 + b"\n", None)
    assert (path, size) == ("a/b", 7)
    for wrong in (b"5 a=\n9 b", b" 5a=\n", b"-5 a=\n", b"999999999999 a=\n", b"0 a\n", b"2 \n", b"x"):
        with pytest.raises(ValueError, match=r"."):
            _pax_values(wrong, None)


@pytest.mark.parametrize("in_folder", [False, True])
@pytest.mark.parametrize("mode", [0o755, 0o777])
def test_a_hard_link_that_another_can_have_made_is_not_read(
    mode: int, in_folder: bool, tmp_path: Path
) -> None:
    """In a folder where others may write, its second name can be a stranger's; in one's own it is a copy that saves room."""
    (tmp_path / "secret.yaml").write_text("seeds: {turn: [40302]}")
    folder = tmp_path / "in"
    folder.mkdir()
    os.link(tmp_path / "secret.yaml", folder / "ada.py")
    folder.chmod(mode)
    work = folder if in_folder else folder / "ada.py"
    if mode == 0o755:
        assert b"40302" in read_submission(work, "ada.py").files["ada.py"]
    else:
        with pytest.raises(SubmissionRefused, match="another name of a file"):
            read_submission(work, "ada.py")


@pytest.mark.skipif(os.geteuid() != 0, reason="needs files of two users")
def test_a_hard_link_in_a_folder_of_another_user_is_not_read(tmp_path: Path) -> None:
    (tmp_path / "secret.yaml").write_text("seeds: {turn: [40302]}")
    folder = tmp_path / "ada"
    folder.mkdir()
    os.link(tmp_path / "secret.yaml", folder / "ada.py")
    os.chown(folder, 65_534, 65_534)
    with pytest.raises(SubmissionRefused, match="another name of a file"):
        read_submission(folder, "ada.py")


HIDDEN = (
    b"# -*- coding: utf-7 -*-\n# harmless: +AAoAaQBtAHAAbwByAHQAIABvAHM-\n",
    b"# coding: unicode_escape\n# harmless \\nimport os\n",
    "ok = 1  # \u202e }if admin\u2066 begin\n".encode(),
    b"import math  # harmless\rimport os\nok = 1\n",
)
SHOWN = (
    b"# -*- coding: latin-1 -*-\nname = 'Jos\xe9'\n",
    "\ufeffname = 'José'\r\nok = 1\r\n".encode(),
    "name = '\u05e9\u05dc\u05d5\u05dd'  # read from right to left, without marks\n".encode(),
    b"ok = 1\rfine = 2\r",
    b"ok = 1\r\r\nfine = 2\r\r\n",
    b"# coding: no-such-thing\n",
)


@pytest.mark.parametrize("inside", [False, True])
@pytest.mark.parametrize("source", HIDDEN)
def test_what_reads_otherwise_than_it_runs_is_refused(source: bytes, inside: bool, tmp_path: Path) -> None:
    folder = tmp_path / "ada"
    folder.mkdir()
    (folder / "controller.py").write_bytes(b"import other\n" if inside else source)
    (folder / "other.py").write_bytes(source)
    with pytest.raises(SubmissionRefused, match=r"encoding|direction|line ends"):
        read_submission(folder if inside else folder / "controller.py", "controller.py")


@pytest.mark.parametrize("source", SHOWN)
def test_what_reads_as_it_runs_is_taken(source: bytes, tmp_path: Path) -> None:
    (tmp_path / "controller.py").write_bytes(source)
    assert read_submission(tmp_path / "controller.py", "controller.py").files["controller.py"] == source


def test_an_archive_alone_in_a_folder_is_the_work(tmp_path: Path) -> None:
    """As a platform's download has it: a folder for each student, and in it what was uploaded."""
    folder = tmp_path / "Ada_4711_assignsubmission_file_"
    folder.mkdir()
    with zipfile.ZipFile(folder / "work.zip", "w") as archive:
        archive.writestr("deep/controller.py", "pass\n")
        archive.writestr("deep/part.py", "x = 1\n")
    (folder / "screenshot.png").write_bytes(b"\x89PNG")
    submission = read_submission(folder, "controller.py")
    assert set(submission.files) == {"controller.py", "part.py"}
    shutil.copy(folder / "work.zip", folder / "again.zip")
    with pytest.raises(SubmissionRefused, match="missing"):
        read_submission(folder, "controller.py")
    (folder / "again.zip").unlink()
    (folder / "controller.py").write_text("print()\n")
    assert set(read_submission(folder, "controller.py").files) == {"controller.py"}
