"""Wrong works that are written as edits of their solution: what differs, and nothing that does not.

A file ``wrong/CRITERION__why.diff`` is a unified diff without need of line numbers, as ``diff -U1 solution.py wrong.py``
prints it: lines that begin with ``-`` are replaced by those that begin with ``+``, at the place where they stand
together with the lines that begin with a space. Parts are separated by lines that begin with ``@@``.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby
from pathlib import Path
from typing import Final

ENDING: Final = ".diff"


class EditsError(ValueError):
    """Edits that do not fit their solution."""


def apply_edits(solution: str, edits: str) -> str:
    """Returns the solution with the edits made, each after the one before.

    Raises EditsError where what an edit replaces does not stand there, or stands there more than once.

    >>> apply_edits("speed = 0.5\\nturn = 1.0\\n", "@@\\n speed = 0.5\\n-turn = 1.0\\n+turn = -1.0\\n")
    'speed = 0.5\\nturn = -1.0\\n'
    """
    lines, done = solution.split("\n"), 0
    for number, part in enumerate(_parts(edits), 1):
        old = [line[1:] for line in part if line[:1] in ("", " ", "-")]
        new = [line[1:] for line in part if line[:1] in ("", " ", "+")]
        places = [
            start
            for start in range(done, len(lines) - len(old) + 1)
            if old and lines[start : start + len(old)] == old
        ]
        if len(places) != 1:
            shown = "\n".join(old) or "nothing: give a line beside it"
            count = "not in the solution" if not places else f"there {len(places)} times"
            raise EditsError(f"edit {number}: what it replaces is {count}:\n{shown}")
        lines[places[0] : places[0] + len(old)] = new
        done = places[0] + len(new)
    return "\n".join(lines)


def _parts(edits: str) -> Iterator[list[str]]:
    """The lines of each part; the names of files above the first are no part."""
    lines = edits.removesuffix("\n").split("\n")
    first = next((i for i, line in enumerate(lines) if line.startswith("@@")), len(lines))
    for is_head, part in groupby(lines[first:], lambda line: line.startswith("@@")):
        if not is_head:
            yield [line for line in part if not line.startswith("\\")]


def list_wrong_works(folder: Path, ending: str) -> list[Path]:
    """The wrong works of a folder: files with the ending of what is handed in, folders, and edits of the solution."""
    return sorted(
        each
        for each in folder.glob("[!._]*")
        if each.name != "__pycache__" and (each.is_dir() or each.suffix in (ending, ENDING))
    )


def written_out(work: Path, solution: Path, into: Path) -> Path:
    """The work as it would be handed in: itself, or, for edits, a file in the folder ``into``. Raises EditsError."""
    if work.suffix != ENDING:
        return work
    file = into / f"{work.stem}{solution.suffix}"
    try:
        file.write_text(apply_edits(solution.read_text("utf-8"), work.read_text("utf-8")), "utf-8")
    except (OSError, UnicodeError, EditsError) as error:
        raise EditsError(f"{work.name}: {error}") from error
    return file
