"""Lines of code and commands in the columns that there are, so that what is copied from the screen still runs.

A command that is too long goes on after a backslash, which a shell takes as one line.
"""

from __future__ import annotations

from typing import Final

PROGRAMS: Final = ("kit", "grader")
"""The first words of lines that are commands."""
LEAST_ROOM: Final = 20
QUOTES: Final = "'\"\\"


def broken_code(line: str, room: int) -> list[str]:
    """A line of code on as many lines of at most ``room`` characters as it needs. A command is broken as ``broken_command`` does;
    other code behind a comma, a bracket or a blank where there is one, and goes on four columns further to the right."""
    if is_command(line):
        return broken_command(line, room)
    indent = line[: len(line) - len(line.lstrip())]
    parts: list[str] = []
    while len(line) > room:
        least = len(line) - len(line.lstrip()) + 1
        cut = max((line.rfind(sign, least, room) + 1 for sign in ", (["), default=0)
        parts.append(line[: cut or room].rstrip())
        line = f"{indent}    {line[cut or room :].lstrip()}"
    return [*parts, line]


def is_command(line: str) -> bool:
    """Whether a line is a command to type."""
    return line.split()[:1] in ([name] for name in PROGRAMS)


def broken_command(line: str, room: int) -> list[str]:
    """A command on as many lines of at most ``room`` characters as it needs, each but the last ending in a backslash.

    It is broken between its words. A word that is too long for an indented line begins in the first column of its own; one
    that is longer than a line is broken too, behind a slash where it has one, and then goes on in the first column, for a shell
    joins what stands before the backslash with what follows the line's end.

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
        slash = line.rfind("/", 0, room - 2) + 1
        cut = slash if slash > first + 2 else room - 2
        while quotes[cut] == "\\":  # what follows a backslash stays with it
            cut -= 1
        quote = quotes[cut]
        parts.append(f"{line[:cut]}{quote}\\")
        line = quote + line[cut:]
    return [*parts, line]


def _open_quotes(line: str) -> list[str]:
    """The quotation mark, or backslash, that is open before each character of a command; "" for neither."""
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
