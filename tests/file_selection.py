"""Which test files a process imports: importing them all is most of what collecting the tests takes.

It leaves out a file that by its text can hold no test which the expression after ``-m`` selects. With ``-n 3 --dist each``
every worker has a share of the files; otherwise each worker of pytest-xdist imports them all.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from itertools import chain, combinations
from pathlib import Path
from typing import Final

from _pytest.mark.expression import Expression

MARKERS: Final = {
    "long": {"long"},
    "long_cases": {"long"},
    "nightly": {"long", "nightly"},
    "daily": {"long", "nightly"},
    "sampled": {"long"},
}
"""The markers that a word in the text can bring to a test (``tests/conftest.py``)."""
_WORD: Final = re.compile(rf"\b({'|'.join(MARKERS)})\b")
_WHOLE_FILE: Final = re.compile(r"^pytestmark = .*\bmark\.(long|nightly)\b", re.MULTILINE)


def may_select(expression: str, text: str) -> bool:
    """Returns whether an expression such as ``long and not nightly`` can be true of a test in a file with this text.

    Raises SyntaxError if the expression is none.
    """
    compiled = Expression.compile(expression)
    certain = {marker for word in _WHOLE_FILE.findall(text) for marker in MARKERS[word]}
    possible = {marker for word in _WORD.findall(text) for marker in MARKERS[word]}
    # What else the expression names, such as `pty`, a test may have or not.
    unsure = sorted((possible | (compiled.idents() - {"long", "nightly"})) - certain)
    choices = chain.from_iterable(combinations(unsure, count) for count in range(len(unsure) + 1))
    return any(compiled.evaluate(certain.union(chosen).__contains__) for chosen in choices)


def shares(files: Iterable[Path], count: int) -> list[set[Path]]:
    """Returns the files in so many shares of about the same size in bytes: no better measure of their time was found that
    needs no upkeep. The same files give the same shares in every process."""
    found: list[set[Path]] = [set() for _ in range(count)]
    sizes = [0] * count
    for size, file in sorted(((file.stat().st_size, file) for file in files), reverse=True):
        smallest = sizes.index(min(sizes))
        found[smallest].add(file)
        sizes[smallest] += size
    return found
