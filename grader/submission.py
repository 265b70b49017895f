"""Reads a submission as bytes: one snapshot with a digest, the same for every test.

Nothing is imported, and only plain files are accepted: no links, no devices, no pipes.
"""

from __future__ import annotations

import hashlib
import os
import stat
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from grader.archives import MAX_BYTES, MAX_FILES, SubmissionRefused, check_name, is_archive, unpack_archive
from kit.host.private_folder import private_folder

IGNORED_NAMES: Final = ("__pycache__", "__MACOSX", ".DS_Store", ".git", ".venv", ".ipynb_checkpoints")
"""Files and folders that are often submitted by accident."""


@dataclass(frozen=True, slots=True)
class Submission:
    """The submitted files by relative name (with ``/``), and which of them the assignment asks for."""

    name: str
    """The student's, or the file's."""
    main: str
    files: Mapping[str, bytes]

    @property
    def digest(self) -> str:
        """Digest of all names and contents."""
        digest = hashlib.sha256(self.main.encode())
        for name, content in sorted(self.files.items()):
            digest.update(repr((name, len(content))).encode())
            digest.update(content)
        return digest.hexdigest()[:32]

    @contextmanager
    def in_temporary_folder(self) -> Iterator[Path]:
        """Writes the files, read-only, into a temporary folder; the context's value is the main file's path."""
        with private_folder() as outer_folder:
            # Only a program that runs as another user needs the folder's mode; no other may get through to it.
            folder = outer_folder / "work"
            folder.mkdir()
            for name, content in self.files.items():
                path = Path(folder, name)
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(content)
                path.chmod(0o444)
            folder.chmod(0o755)
            yield Path(folder, self.main)


def read_submission(path: Path, main: str) -> Submission:
    """Reads the submission at ``path``: the file itself, or a folder or archive that holds the file ``main``.

    Raises SubmissionRefused, with a message for the student.
    """
    if path.is_symlink():
        raise SubmissionRefused(f"{path.name} is a link; hand in the file itself.")
    if path.is_dir():
        return _find_main_file(path.name, dict(_folder_files(path)), main)
    content = _read_plain_file(path)
    if is_archive(path.name):
        return _find_main_file(_archive_stem(path), unpack_archive(content, path.name), main)
    return Submission(path.stem, main, {main: content})


def _find_main_file(name: str, files: Mapping[str, bytes], main: str) -> Submission:
    """Finds the main file: at the top, or in the only folder that holds one."""
    matches = sorted(
        (each for each in files if each == main or each.endswith(f"/{main}")),
        key=lambda each: each.count("/"),
    )
    if not matches:
        join_faults = ", ".join(sorted(files)[:5]) or "nothing"
        raise SubmissionRefused(f"{main} is missing. What was handed in: {join_faults}.")
    if len(matches) > 1 and matches[0].count("/") == matches[1].count("/"):
        raise SubmissionRefused(f"{main} is there more than once: {', '.join(matches[:3])}.")
    top = matches[0].removesuffix(main)
    return Submission(
        name,
        main,
        {each.removeprefix(top): content for each, content in files.items() if each.startswith(top)},
    )


def _folder_files(folder: Path) -> Iterator[tuple[str, bytes]]:
    """Yields the name and content of each plain file below a folder."""
    total = count = 0
    for path_name, folders, names in os.walk(folder, followlinks=False):
        folders[:] = sorted(each for each in folders if each not in IGNORED_NAMES)
        for link in folders:
            if Path(path_name, link).is_symlink():
                raise SubmissionRefused(f"{link} is a link; hand in files only.")
        for name in sorted(names):
            path = Path(path_name, name)
            relative = path.relative_to(folder).as_posix()
            if name in IGNORED_NAMES:
                continue
            check_name(relative)
            content = _read_plain_file(path)
            total, count = total + len(content), count + 1
            if total > MAX_BYTES or count > MAX_FILES:
                raise SubmissionRefused(
                    f"More than {MAX_FILES} files or {MAX_BYTES >> 20} MiB; hand in your program alone."
                )
            yield relative, content


def _read_plain_file(path: Path) -> bytes:
    """Reads a plain file without following a link, blocking on a pipe, or reading without end."""
    try:
        handle = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC)
    except OSError as error:
        reason = "it is a link" if path.is_symlink() else error.strerror
        raise SubmissionRefused(f"{path.name} cannot be read: {reason}.") from None
    with os.fdopen(handle, "rb") as file:
        status = os.fstat(handle)
        if not stat.S_ISREG(status.st_mode):
            raise SubmissionRefused(f"{path.name} is not a plain file.")
        content = file.read(MAX_BYTES + 1)
    if len(content) > MAX_BYTES:
        raise SubmissionRefused(f"{path.name} is larger than {MAX_BYTES >> 20} MiB.")
    return content


def _archive_stem(path: Path) -> str:
    name = path.name
    for ending in (".tar.gz", ".tgz", ".tar", ".zip"):
        name = name.removesuffix(ending)
    return name
