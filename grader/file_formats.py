"""What kind of file somebody has handed in by mistake, and what to do instead."""

from __future__ import annotations

from pathlib import PurePosixPath
from typing import Final

from grader.hidden_code import hidden_code
from grader.shown_names import shown_name

YAML_ENDINGS: Final = (".yaml", ".yml")
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
