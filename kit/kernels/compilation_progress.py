"""Which kernel is being compiled, and how many have been: the first start on a machine compiles those that it needs.

Imports no numba: whoever shows the progress does so before that is loaded.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Final

FIRST_DRIVE: Final = 28
"""Functions that are compiled before the first robot of a machine moves, on any map; a test counts them."""


class CompilationProgress:
    """What numba compiles in this process, in whichever thread first needs a function."""

    def __init__(self) -> None:
        self.count = 0
        """Functions that have been compiled; those read from the disk do not count."""
        self._names: list[str] = []
        self._tell: Callable[[str], None] = lambda text: None

    def begin(self, name: str) -> None:
        """A function begins to be compiled, perhaps within another one that calls it."""
        self._names.append(name)
        if len(self._names) == 1:
            self._tell(self.text)

    def end(self) -> None:
        """The function that began last is done."""
        self._names.pop()
        self.count += 1

    @property
    def text(self) -> str:
        """``Compiling for this machine, once: scan_rays, 4 of about 28``; empty while nothing is compiled.

        Without the sum where more is compiled than a drive needs, as for a training."""
        if not self._names:
            return ""
        of = f" of about {FIRST_DRIVE}" if self.count < FIRST_DRIVE else " so far"
        return f"Compiling for this machine, once: {self._names[0]}, {self.count}{of}"

    @contextmanager
    def told_by(self, tell: Callable[[str], None]) -> Iterator[None]:
        """Calls ``tell`` with the text whenever another function begins, in the block."""
        before, self._tell = self._tell, tell
        try:
            yield
        finally:
            self._tell = before


PROGRESS: Final = CompilationProgress()
"""Of this process; numba's own listeners are the process's too."""
