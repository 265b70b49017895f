"""Rules for submitted files: which are needed, which are ignored, and how many and how large they may be."""

from __future__ import annotations

import re
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path, PurePosixPath
from typing import Final

from grader.file_formats import DOCUMENT_ENDINGS, PICTURE_ENDINGS, YAML_ENDINGS
from grader.shown_names import DRIVE_PATTERN, shown_name

MAX_FILES: Final = 200
MAX_BYTES: Final = 8 * 1024 * 1024
"""Bytes of all needed files together, unpacked."""
MAX_DEPTH: Final = 6
"""Levels of nested folders, the file's own name included."""
MAX_ENTRIES: Final = 50_000
"""Files and folders of all sorts, those that are ignored included."""
READ_SIZE: Final = 65_536
"""Bytes read at once."""

IGNORED_NAMES: Final = frozenset(
    ("__pycache__", "__macosx", "venv", "node_modules", "site-packages", "thumbs.db", "desktop.ini")
)
"""Files and folders, in lower case, that are often submitted by accident, beside all whose names begin with a dot."""
VIRTUAL_ENVIRONMENT_FILE: Final = "pyvenv.cfg"
"""Python's mark of a virtual environment, whatever its folder is called."""
_PROJECT: Final = Path(__file__).parents[1]


def is_ignored_name(name: str) -> bool:
    """Whether a file or folder of this name is not looked at."""
    return name.startswith(".") or name.casefold() in IGNORED_NAMES


class SubmissionRefused(Exception):
    """The submission cannot be graded; the message tells the student why, and what to do."""


class SubmissionUnreadable(SubmissionRefused):
    """Reading the submission ended with an error that no reader expects; ``error`` says which, and where."""

    def __init__(self, message: str, error: str) -> None:
        super().__init__(message)
        self.error = error


@contextmanager
def reading_submission(name: str, *expected: type[Exception]) -> Iterator[None]:
    """Turns every error of a reader that is not ``expected`` into SubmissionUnreadable, so that it costs this submission
    alone."""
    try:
        yield
    except Exception as error:
        if isinstance(error, (SubmissionRefused, *expected)):
            raise
        kind = type(error).__name__
        raise SubmissionUnreadable(
            f"{ascii(name)[1:-1]} cannot be read ({kind}). Open it, save it again, and hand in the program alone, as a "
            "plain file.",
            f"{kind} in {_innermost_place(error)}",
        ) from error


def _innermost_place(error: Exception) -> str:
    """Returns the innermost line of this project in an error's traceback: ``grader/archives.py:40``."""
    places = ["?"]
    for frame in traceback.walk_tb(error.__traceback__):
        file = Path(frame[0].f_code.co_filename)
        if file.is_relative_to(_PROJECT) and "site-packages" not in file.relative_to(_PROJECT).parts:
            places.append(f"{file.relative_to(_PROJECT).as_posix()}:{frame[1]}")
    return places[-1]


class SubmittedFiles:
    """Takes the needed files of one submission, within limits, and remembers which were ignored."""

    def __init__(self, main: str, max_bytes: int = MAX_BYTES) -> None:
        self.files: dict[str, bytes] = {}
        self._ignored: dict[str, None] = {}
        self._takes_pictures = main.endswith(YAML_ENDINGS)  # a world's map is a picture
        self._entries_left = MAX_ENTRIES
        self._bytes_left = min(MAX_BYTES, max_bytes)
        self._lower: set[str] = set()
        self._folders: set[str] = set()
        """Folders of the files in ``_lower``; both in lower case."""

    @property
    def ignored(self) -> tuple[str, ...]:
        return tuple(self._ignored)

    def count_entry(self) -> None:
        """Counts a file, a folder or a header. Raises SubmissionRefused for too many."""
        self._entries_left -= 1
        if self._entries_left < 0:
            raise SubmissionRefused(
                f"More than {MAX_ENTRIES} files and folders: hand in only your program, without the folders of "
                "other programs."
            )

    def needs(self, path: str, *, is_folder: bool = False) -> bool:
        """Counts an entry, and returns whether it must be read (a folder: entered). Raises SubmissionRefused.

        ``path``: relative, with ``/``. What is not needed is remembered as ignored.
        """
        self.count_entry()
        parts = path.split("/")
        if path.startswith(("/", "\\")) or ".." in re.split(r"[/\\]", path) or DRIVE_PATTERN.match(path):
            raise SubmissionRefused(
                f"{shown_name(path)} leads out of the folder: pack the files again by their plain names."
            )
        for number, part in enumerate(parts[:MAX_DEPTH], 1):  # what lies deeper is not needed either
            top = "/".join(parts[:number])
            if is_ignored_name(part) or top in self._ignored:
                self.ignore(top)
                return False
        if len(parts) + is_folder > MAX_DEPTH:
            self.ignore("/".join(parts[: MAX_DEPTH - 1]) + "/...")
            return False
        ending = PurePosixPath(path).suffix.lower()
        if not is_folder and (
            ending in DOCUMENT_ENDINGS or (ending in PICTURE_ENDINGS and not self._takes_pictures)
        ):
            self.ignore(path)
            return False
        return True

    def ignore(self, path: str) -> None:
        self._ignored[path] = None

    def add(self, path: str, read: Callable[[int], bytes]) -> None:
        """Takes a file's content, whose true bytes count: a size that an archive declares is not trusted."""
        if path.lower() in self._lower:
            raise SubmissionRefused(
                f"{shown_name(path)} is there twice, or differs only in upper and lower case: leave one out."
            )
        folders = [str(folder) for folder in PurePosixPath(path.lower()).parents]
        if path.lower() in self._folders or self._lower.intersection(folders):
            raise SubmissionRefused(
                f"{shown_name(path)} is a file and a folder at once, or differs from one only in upper and lower case: "
                "leave one out."
            )
        if len(self.files) >= MAX_FILES:
            raise SubmissionRefused(
                f"More than {MAX_FILES} files or {MAX_BYTES >> 20} MiB; hand in only your program."
            )
        self._lower.add(path.lower())
        self._folders.update(folders)
        content = bytearray()
        while chunk := read(min(READ_SIZE, self._bytes_left + 1)):
            self._bytes_left -= len(chunk)
            if self._bytes_left < 0:
                raise SubmissionRefused(
                    f"Its files take more than {MAX_BYTES >> 20} MiB, unpacked, or it is a decompression bomb; hand in "
                    "your program alone."
                )
            content += chunk
        self.files[path] = bytes(content)
