"""What can be wrong with a launch file, with the place in it."""

from __future__ import annotations

import sys
from typing import Final, NamedTuple

_HERE: Final = __file__.rpartition("/launch/")[0]
"""The folder of ``kit.ros``: frames below it are the library's, frames elsewhere the launch file's author's."""


class Place(NamedTuple):
    """A line of somebody's launch file."""

    file: str
    line: int


class LaunchError(Exception):
    """A launch file that cannot be carried out; ``place`` is the line to look at, if it is known."""

    def __init__(self, message: str, place: Place | None = None) -> None:
        super().__init__(message)
        self.place = place


class SubstitutionFailure(LaunchError):
    """A substitution that cannot be performed."""


def calling_place() -> Place | None:
    """The innermost line outside this library that is being run."""
    frame = sys._getframe(1)
    while frame.f_code.co_filename.startswith(_HERE):
        if frame.f_back is None:
            return None
        frame = frame.f_back
    return Place(frame.f_code.co_filename, frame.f_lineno)
