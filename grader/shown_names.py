"""Names of submitted files in messages, and which are plain."""

from __future__ import annotations

import os
import re
from typing import Final

from grader.look_alikes import mark_foreign_letters

_NAME_PATTERN: Final = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_. +\-()]{0,99}")
DRIVE_PATTERN: Final = re.compile(r"[A-Za-z]:")


def is_plain_name(path: str) -> bool:
    """True for a relative path of plain characters, that nothing can mistake for another."""
    return all(_NAME_PATTERN.fullmatch(part) and not part.endswith((".", " ")) for part in path.split("/"))


def readable_name(name: str) -> str:
    """Returns a file's name as text that can be written: bytes that are not UTF-8, which Python reads as halves of surrogates,
    are replaced."""
    return os.fsencode(name).decode("utf-8", "replace")


def shown_name(path: str) -> str:
    """Returns a name for a message: in quotes, shortened, without characters that cannot be seen or that look like others."""
    return mark_foreign_letters(repr(path[:80]))
