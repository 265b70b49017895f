"""Paths and commands as a student copies them from the screen: what stands there can be pasted into a shell.

A path below the home folder begins with ``~``. A command that is too long for the screen goes on after a backslash,
which a shell takes as one line.
"""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Final

PROGRAMS: Final = ("kit", "grader")
"""The first words of lines that are commands."""
LEAST_ROOM: Final = 20
QUOTES: Final = "'\"\\"


def shell_path(path: Path) -> str:
    """A path as a shell takes it, short where it lies in the home folder.

    >>> shell_path(Path.home() / "kit" / "my file.py")
    "~/kit/'my file.py'"
    """
    try:
        below = path.relative_to(Path.home())
    except (ValueError, RuntimeError):  # not below it, or there is no home folder
        return shlex.quote(str(path))
    if not below.parts:
        return "~"
    return "~/" + "/".join(shlex.quote(part) for part in below.parts)


def fill_in_paths(text: str, file: Path | None) -> str:
    """Replaces ``{file}`` and ``{folder}`` by the student's own file and its folder. None: nothing is replaced."""
    if file is None:
        return text
    return text.replace("{file}", shell_path(file)).replace("{folder}", shell_path(file.parent))


def expand_words(words: list[str]) -> list[str]:
    """Words of a command as a shell hands them on: a leading ``~/`` is the home folder."""
    return [str(Path(word).expanduser()) if word.startswith("~/") else word for word in words]


def is_command(line: str) -> bool:
    """Whether a line is a command to type."""
    return line.split()[:1] in ([name] for name in PROGRAMS)


def broken_command(line: str, room: int) -> list[str]:
    """A command on as many lines of at most ``room`` characters as it needs, each but the last ending in a backslash.

    It is broken between its words. A word that is too long for an indented line begins in the first column of its own; one
    that is longer than a line is broken too, and then goes on in the first
    column, for a shell joins what stands before the backslash with what follows the line's end.

    >>> broken_command("  kit run maze --controller avoid", 22)
    ['  kit run maze \\\\', '    --controller avoid']
    """
    room = max(room, LEAST_ROOM)
    indent = line[: len(line) - len(line.lstrip())]
    parts: list[str] = []
    while len(line) > room:
        quotes = _open_quotes(line)
        first = len(line) - len(line.lstrip())
        blanks = [at for at in range(first, room - 1) if line[at] == " " and not quotes[at]]
        if blanks:
            parts.append(f"{line[: blanks[-1]]} \\")
            line = f"{indent}  {line[blanks[-1] :].lstrip()}"
            continue
        if first and len(line) - first <= room:  # a word that fits where it begins further left
            line = line.lstrip()
            continue
        cut = room - 2
        while quotes[cut] == "\\":  # what follows a backslash stays with it
            cut -= 1
        quote = quotes[cut]
        parts.append(f"{line[:cut]}{quote}\\")
        line = quote + line[cut:]
    return [*parts, line]


def _open_quotes(line: str) -> list[str]:
    """For each character of a command the quotation mark that is open before it, or the backslash; "" for neither."""
    states: list[str] = []
    state = ""
    for character in line:
        states.append(state)
        if state == "\\":
            state = ""
        elif state:
            state = "" if character == state else state
        elif character in QUOTES:
            state = character
    return states
