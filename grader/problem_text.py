"""What is wrong with a file that was handed in, as its author reads it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from kit.host.wire import printable
from kit.world.problems import WorldError


def problems_text(error: Exception, folder: Path | None = None) -> str:
    """Returns what an error says, each of several problems in a line of its own. ``folder``: the temporary copy of what was
    handed in, whose path means nothing to the author."""
    problems = list(map(str, error.problems)) if isinstance(error, WorldError) else [str(error)]
    return numbered([each.replace(f"{folder}/", "") if folder is not None else each for each in problems])


def numbered(problems: Sequence[str]) -> str:
    """Returns one problem as it is, several with numbers, each in a line of its own.

    >>> numbered(["a wall is missing"]), numbered(["no wall", "no robot"])
    ('a wall is missing', '\\n(1) no wall\\n(2) no robot')
    """
    told = [printable(each) for each in problems]
    if len(told) < 2:
        return "".join(told)
    return "".join(f"\n({number}) {each}" for number, each in enumerate(told, 1))
