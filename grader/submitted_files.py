"""Rules for submitted files: which are needed, which are ignored, and how many and how large they may be."""

from __future__ import annotations

import codecs
import io
import re
import tokenize
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path, PurePosixPath
from typing import Final

from grader.look_alikes import mark_foreign_letters

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
PICTURE_ENDINGS: Final = frozenset(
    [".png", ".jpg", ".jpeg", ".gif", ".bmp", ".svg", ".webp", ".tif", ".tiff", ".heic", ".ico"]
)
DOCUMENT_ENDINGS: Final = frozenset(
    [
        ".pdf",
        ".doc",
        ".docx",
        ".odt",
        ".rtf",
        ".ppt",
        ".pptx",
        ".odp",
        ".xls",
        ".xlsx",
        ".ods",
        ".pages",
        ".key",
        ".mp4",
        ".mov",
        ".mkv",
        ".avi",
        ".webm",
        ".mp3",
        ".wav",
        ".7z",
        ".rar",
        ".zip",
        ".tar",
        ".gz",
        ".tgz",
        ".xz",
        ".bz2",
        ".ipynb",
        ".pyc",
        ".bag",
        ".db3",
        ".mcap",
        ".lnk",
        ".exe",
        ".dmg",
    ]
)
YAML_ENDINGS: Final = (".yaml", ".yml")

_NAME_PATTERN: Final = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_. +\-()]{0,99}")
_DRIVE_PATTERN: Final = re.compile(r"[A-Za-z]:")
_PROJECT: Final = Path(__file__).parents[1]


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
        if path.startswith(("/", "\\")) or ".." in re.split(r"[/\\]", path) or _DRIVE_PATTERN.match(path):
            raise SubmissionRefused(
                f"{shown_name(path)} leads out of the folder: pack the files again by their plain names."
            )
        for number, part in enumerate(parts, 1):
            top = "/".join(parts[:number])
            if part.startswith(".") or part.lower() in IGNORED_NAMES or top in self._ignored:
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


def is_plain_name(path: str) -> bool:
    """True for a relative path of plain characters, that nothing can mistake for another."""
    return all(_NAME_PATTERN.fullmatch(part) and not part.endswith((".", " ")) for part in path.split("/"))


def shown_name(path: str) -> str:
    """Returns a name for a message: in quotes, shortened, without characters that cannot be seen or that look like others."""
    return mark_foreign_letters(repr(path[:80]))


_SIGNATURES: Final = (
    (b"7z\xbc\xaf\x27\x1c", "a 7-Zip archive"),
    (b"Rar!\x1a\x07", "a RAR archive"),
    (b"PK\x03\x04", "a zip archive or an office document"),
    (b"\x1f\x8b", "a gzip archive"),
    (b"\xfd7zXZ\x00", "an xz archive"),
    (b"%PDF-", "a PDF"),
    (b"\x89PNG\r\n", "a picture"),
    (b"\xff\xd8\xff", "a picture"),
    (b"GIF8", "a picture"),
    (b"\xd0\xcf\x11\xe0", "an office document"),
)
_ENDINGS: Final = {
    ".7z": "a 7-Zip archive",
    ".rar": "a RAR archive",
    ".zip": "a zip archive",
    ".tar": "an archive",
    ".gz": "an archive",
    ".tgz": "an archive",
    ".xz": "an archive",
    ".bz2": "an archive",
    ".ipynb": "a Jupyter notebook",
    ".pdf": "a PDF",
    ".docx": "a Word document",
    ".doc": "a Word document",
    ".odt": "a text document",
    ".pyc": "a compiled program",
}
PACK_ADVICE: Final = "unpack it and hand in the file itself, or pack it as .zip or .tar.gz"
NOTEBOOK_ADVICE: Final = (
    "in Jupyter choose File > Save and Export Notebook As > Executable Script, and hand in the .py file"
)


def file_kind(content: bytes) -> str | None:
    """Returns what kind of file begins like this, if it is one that is often handed in by mistake."""
    kind = next((kind for signature, kind in _SIGNATURES if content.startswith(signature)), None)
    if kind is None and content.lstrip()[:1] == b"{" and b'"nbformat"' in content and b'"cells"' in content:
        return _ENDINGS[".ipynb"]
    return kind


def wrong_format(name: str, content: bytes, main: str) -> str:
    """Returns what a file is and what to do, if it cannot be what the assignment asks for; else an empty text."""
    if not main.endswith((".py", *YAML_ENDINGS)):
        return ""  # the kind's own reader says what is wrong with it
    shown = shown_name(name)[1:-1]
    if not content.strip():
        return f"{shown} is empty: save your work in it, and hand it in again."
    kind = file_kind(content)
    if kind is not None:
        asked = "a Python file" if main.endswith(".py") else "a YAML file"
        return f"{shown} is {kind}, not {asked}: {advice(kind)}."
    if _is_utf_16(content):
        return f"{shown} is saved as UTF-16: open it in an editor, save it as UTF-8, and hand it in again."
    return hidden_code(name, content) if main.endswith(".py") else ""


READ_AS_SHOWN: Final = ("utf-8", "ascii", "iso8859-1", "iso8859-15", "cp1250", "cp1251", "cp1252")
"""Encodings in which a line of a program reads in Python as an editor shows it. In others a comment can hold a program."""
_DIRECTIONS: Final = frozenset("\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069")
"""Marks that change the writing direction: what they enclose reads in another order than Python reads it."""


def hidden_code(name: str, content: bytes) -> str:
    """Returns how a Python file reads otherwise in Python than in an editor, and what to do; else an empty text.

    Who reviews a work must see what runs. Trojan Source: https://trojansource.codes, CVE-2021-42574.
    """
    shown = shown_name(name)[1:-1]
    try:
        encoding = codecs.lookup(tokenize.detect_encoding(io.BytesIO(content).readline)[0]).name
        text = content.decode(encoding)
    except (SyntaxError, LookupError, UnicodeError):
        return ""  # Python says what is wrong with it
    if encoding.removesuffix("-sig") not in READ_AS_SHOWN:
        return f"{shown} is written in the encoding {encoding}, which no editor shows as it runs: save it as UTF-8."
    for number, line in enumerate(text.replace("\r\n", "\n").split("\n"), 1):
        if not _DIRECTIONS.isdisjoint(line):
            return f"{shown}, line {number}: marks that change the writing direction hide what runs; remove them."
        if "\r" in line.rstrip("\r") and "\n" in text:
            return f"{shown}, line {number}: it ends in the middle for Python alone; save it with ordinary line ends."
    return ""


def what_instead(paths: list[str]) -> str:
    """Returns a sentence on the first of these files that may hold the program in another format; may be empty."""
    for path in paths:
        kind = _ENDINGS.get(PurePosixPath(path).suffix.lower())
        if kind is not None and kind != _ENDINGS[".pdf"]:
            return f" {shown_name(path)[1:-1]} is {kind}: {advice(kind)}."
    return ""


def advice(kind: str) -> str:
    """Returns what to do with a file of this kind."""
    if kind == _ENDINGS[".ipynb"]:
        return NOTEBOOK_ADVICE
    return PACK_ADVICE if "archive" in kind else "hand in the program itself"


def _is_utf_16(content: bytes) -> bool:
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        return True
    sample = content[:2000]
    zeros = [number % 2 for number, byte in enumerate(sample) if byte == 0]
    return len(zeros) > 0.4 * len(sample) and len(set(zeros)) == 1
