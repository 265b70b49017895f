"""Reads a submission as bytes: one snapshot with a digest, the same for every test.

Nothing is imported, and only plain files are accepted: no links, no devices, no pipes.
"""

from __future__ import annotations

import errno
import hashlib
import os
import stat
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO, Final

from grader.archives.archive import MAX_PACKED_BYTES, archive_stem, unpack_archive
from grader.archives.streams import packed_limit
from grader.file_formats import YAML_ENDINGS, what_instead, wrong_format
from grader.hidden_code import hidden_code
from grader.shown_names import is_plain_name, readable_name, shown_name
from grader.submitted_files import (
    MAX_BYTES,
    VIRTUAL_ENVIRONMENT_FILE,
    SubmissionRefused,
    SubmittedFiles,
    reading_submission,
)
from kit.host.private_folder import private_folder
from kit.plain_files import open_plain_file

MAX_NAMED: Final = 6
"""Ignored files that a note names."""


@dataclass(frozen=True, slots=True)
class Submission:
    """The submitted files by relative name (with ``/``), and which of them the assignment asks for."""

    name: str
    """The student's, or the file's."""
    main: str
    files: Mapping[str, bytes]
    note: str = ""
    """What was ignored, and which file was taken for the main one; empty if there is nothing to say."""

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

    Raises SubmissionRefused, with a message for the student; nothing else, whatever was handed in.
    """
    with reading_submission(path.name):
        return _read_submission(path, main)


def submission_name(path: Path) -> str:
    """Returns the name of what was handed in: without the ending of a file or an archive, other dots kept."""
    if path.is_dir():
        return readable_name(path.name)
    stem = archive_stem(path.name)
    return readable_name(path.stem if stem is None else stem)


def _read_submission(path: Path, main: str) -> Submission:
    if path.is_symlink():
        raise SubmissionRefused(f"{shown_name(path.name)[1:-1]} is a link; hand in the file itself.")
    name = submission_name(path)
    if path.is_dir():
        files = SubmittedFiles(main)
        with _open_folder(path) as folder:
            _read_folder(folder, "", files)
            if (archive := _lone_archive(files)) is not None:
                with _open_plain_file(archive, MAX_PACKED_BYTES, folder) as file:
                    files = SubmittedFiles(main, packed_limit(os.fstat(file.fileno()).st_size))
                    unpack_archive(file, archive, files)
        return _find_main_file(name, files, main)
    if archive_stem(path.name) is not None:
        with _open_plain_file(path, MAX_PACKED_BYTES) as file:
            files = SubmittedFiles(main, packed_limit(os.fstat(file.fileno()).st_size))
            unpack_archive(file, path.name, files)
        return _find_main_file(name, files, main)
    with _open_plain_file(path, MAX_BYTES) as file:
        content = file.read(MAX_BYTES + 1)
    _refuse_wrong_format(path.name, content, main)
    return Submission(name, main, {main: content})


def _lone_archive(files: SubmittedFiles) -> str | None:
    """The archive in a folder that holds nothing else that could be the work: platforms put each student's upload into a
    folder of its own. None if there is none, or more than one."""
    archives = [path for path in files.ignored if "/" not in path and archive_stem(path) is not None]
    return archives[0] if len(archives) == 1 and not files.files else None


def _find_main_file(name: str, files: SubmittedFiles, main: str) -> Submission:
    """Finds the main file: at the top, or in the only folder that holds one; a lone program may have any name."""
    found = _main_path(files, main)
    folder, _, own_name = found.rpartition("/")
    top = f"{folder}/" if folder else ""
    kept = {main: files.files[found]}
    _refuse_wrong_format(own_name, kept[main], main)
    for path, content in files.files.items():
        inside = path.removeprefix(top)
        if path == found:
            continue
        if path.startswith(top) and is_plain_name(inside) and inside != main:
            if inside.endswith(".py") and (hidden := hidden_code(inside, content)):
                raise SubmissionRefused(hidden)
            kept[inside] = content
        else:
            files.ignore(path)
    taken = "" if own_name == main else f"{shown_name(own_name)[1:-1]} was taken as {main}."
    return Submission(name, main, kept, " ".join(filter(None, (taken, _ignored_note(files)))))


def _main_path(files: SubmittedFiles, main: str) -> str:
    """Returns the path of the main file. Raises SubmissionRefused if there is none, or more than one."""
    names = {path: path.rpartition("/")[2] for path in files.files}
    endings = YAML_ENDINGS if main.endswith(YAML_ENDINGS) else (Path(main).suffix,)
    exact = [path for path in names if names[path] == main]
    similar = [path for path in names if names[path].lower().strip() == main.lower()]
    programs = [path for path in names if names[path].lower().endswith(endings)]
    matches = sorted(exact or similar, key=lambda path: (path.count("/"), path))
    if not matches and len(programs) == 1:
        return programs[0]
    if not matches:
        handed_in = [*sorted(names), *sorted(files.ignored)]
        shown = ", ".join(shown_name(path)[1:-1] for path in handed_in[:5]) or "nothing"
        way_out = what_instead(handed_in) or f" Give your program the name {main}."
        raise SubmissionRefused(
            f"{main} is missing. What was handed in: {shown}.{way_out if handed_in else ''}"
        )
    if len(matches) > 1 and matches[0].count("/") == matches[1].count("/"):
        shown = ", ".join(shown_name(path)[1:-1] for path in matches[:3])
        raise SubmissionRefused(f"{main} is there more than once: {shown}. Keep only the one that counts.")
    return matches[0]


def _ignored_note(files: SubmittedFiles) -> str:
    """Returns a sentence that names what was ignored; empty if nothing was."""
    named = [shown_name(path)[1:-1] for path in sorted(files.ignored)]
    if not named:
        return ""
    more = f" and {len(named) - MAX_NAMED} more" if len(named) > MAX_NAMED else ""
    return f"Ignored, because it is not needed: {', '.join(named[:MAX_NAMED])}{more}."


def _refuse_wrong_format(name: str, content: bytes, main: str) -> None:
    wrong = wrong_format(name, content, main)
    if wrong:
        raise SubmissionRefused(wrong)


@contextmanager
def _open_folder(path: Path | str, above: int | None = None) -> Iterator[int]:
    """Opens a folder, never through a link; the context's value is its descriptor. Raises SubmissionRefused.

    ``above``: descriptor of the folder that ``path`` is a name in. Everything below is opened through descriptors: somebody
    who exchanges a folder for a link while it is read has no file of the reader's read.
    """
    try:
        flags = os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW | os.O_CLOEXEC
        handle = os.open(path, flags, dir_fd=above)
    except OSError as error:
        shown = shown_name(Path(path).name)[1:-1]
        reason = "it is a link" if error.errno in (errno.ELOOP, errno.ENOTDIR) else error.strerror
        raise SubmissionRefused(f"{shown} cannot be read: {reason}.") from None
    try:
        yield handle
    finally:
        os.close(handle)


def _read_folder(folder: int, prefix: str, files: SubmittedFiles) -> None:
    """Reads the needed files below an open folder; ``prefix`` is its path inside the submission, with ``/`` at its end.

    ``SubmittedFiles`` limits the depth, and so the recursion.
    """
    names: list[tuple[str, bool, bool]] = []
    with os.scandir(folder) as entries:
        for entry in entries:
            path = f"{prefix}{entry.name}"
            is_folder = entry.is_dir(follow_symlinks=False)
            if files.needs(path, is_folder=is_folder):
                names.append((entry.name, is_folder, entry.is_symlink()))
    for name, is_folder, is_link in sorted(names):
        path = f"{prefix}{name}"
        if is_link:
            raise SubmissionRefused(f"{shown_name(path)[1:-1]} is a link; hand in files only.")
        if is_folder:
            with _open_folder(name, folder) as inside:
                if _is_virtual_environment(inside):
                    files.ignore(path)
                else:
                    _read_folder(inside, f"{path}/", files)
        else:
            with _open_plain_file(name, MAX_BYTES, folder) as file:
                files.add(path, file.read)


def _is_virtual_environment(folder: int) -> bool:
    try:
        os.stat(VIRTUAL_ENVIRONMENT_FILE, dir_fd=folder, follow_symlinks=False)
    except OSError:
        return False
    return True


def _is_anothers_file(file: BinaryIO, folder: Path | int) -> bool:
    """True for a hard link that anybody but the file's owner may have made: from a folder that others may write in, or
    of another owner. Where a system lets anybody make one, it would have this process read whatever it may read."""
    status = os.fstat(file.fileno())
    if status.st_nlink < 2:
        return False
    place = folder.stat() if isinstance(folder, Path) else os.fstat(folder)
    return place.st_uid != status.st_uid or bool(place.st_mode & (stat.S_IWGRP | stat.S_IWOTH))


def _open_plain_file(path: Path | str, max_bytes: int, folder: int | None = None) -> BinaryIO:
    """Opens a plain file without following a link or blocking on a pipe. Raises SubmissionRefused."""
    shown = shown_name(Path(path).name)[1:-1]
    try:
        file = open_plain_file(path, follows_links=False, folder=folder)
    except OSError as error:
        reason = "it is a link" if error.errno == errno.ELOOP else error.strerror
        raise SubmissionRefused(f"{shown} cannot be read: {reason}.") from None
    if _is_anothers_file(file, Path(path).parent if folder is None else folder):
        file.close()
        raise SubmissionRefused(
            f"{shown} is another name of a file that lies elsewhere: hand in a copy of it."
        )
    if os.fstat(file.fileno()).st_size > max_bytes:
        file.close()
        raise SubmissionRefused(f"{shown} is larger than {max_bytes >> 20} MiB: hand in only your program.")
    return file
