"""Errors of a launch file, with the line that caused them."""

from __future__ import annotations

import sys
from typing import Final, NamedTuple

_LIBRARY_FOLDER: Final = __file__.rpartition("/launch/")[0]
"""The folder of ``kit.ros``: frames below it are the library's, frames elsewhere the launch file's author's."""


class LaunchFileLocation(NamedTuple):
    """A line of a launch file, or of a module it imports."""

    file: str
    line: int


class LaunchError(Exception):
    """A launch file that cannot be carried out; ``location`` is the line that caused it, if known."""

    def __init__(self, message: str, location: LaunchFileLocation | None = None) -> None:
        super().__init__(message)
        self.location = location


class SubstitutionFailure(LaunchError):
    """A substitution that cannot be performed."""


def calling_location() -> LaunchFileLocation | None:
    """The innermost line of the call stack that is outside this library; None if there is none."""
    frame = sys._getframe(1)
    while frame.f_code.co_filename.startswith(_LIBRARY_FOLDER):
        if frame.f_back is None:
            return None
        frame = frame.f_back
    return LaunchFileLocation(frame.f_code.co_filename, frame.f_lineno)
