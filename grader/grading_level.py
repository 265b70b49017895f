"""At which confinement level submissions are graded: as asked, as the assignment says, as this machine reaches."""

from __future__ import annotations

import sys
from typing import Final

from grader.assignment import Assignment
from kit.host.sandbox.probe import highest_level_up_to
from kit.host.sandbox.sandbox_config import Level

LEVEL_NOT_REACHED: Final = "This machine does not reach confinement level {}; `kit doctor` says why."


class LevelTooLow(Exception):
    """Secret seeds would be used at a lower confinement level than the assignment allows."""


class LevelUnavailable(LevelTooLow):
    """This machine does not reach the confinement level that was requested; the message says what to do."""


def level_for_untrusted(assignment: Assignment, requested: Level | None) -> Level:
    """The confinement level for programs that other people wrote: as requested, else as the assignment says, but at
    least 1."""
    return max(assignment.level, Level.FILTERED) if requested is None else requested


def grading_level(
    assignment: Assignment, requested: Level | None, *, secret: bool, may_lower_level: bool
) -> Level:
    """The level to grade at; tried with an empty program, so that no submission can influence it.

    ``may_lower_level``: whether practice may go on at the highest level that this machine has, at least 1, where no level
    was requested. Raises LevelTooLow.
    """
    level = level_for_untrusted(assignment, requested)
    if secret and level < assignment.level:
        raise LevelTooLow(
            f"{assignment.title} uses its secret.yaml at confinement level {int(assignment.level)} or higher, not at "
            f"{int(level)}: that is the `level` of its assignment.yaml. `kit doctor` says what this machine can do."
        )
    available = highest_level_up_to(level)
    if available == level:
        return level
    if secret or requested is not None or not may_lower_level or available < Level.FILTERED:
        raise LevelUnavailable(level_unavailable_text(assignment, level, secret=secret))
    message = LEVEL_NOT_REACHED.format(int(level))
    sys.stderr.write(f"WARNING: {message} The program runs at level {int(available)}, for practice only.\n")
    return available


def level_unavailable_text(assignment: Assignment, level: Level, *, secret: bool) -> str:
    """Says that this machine does not reach a level, and how to grade at the one that it has."""
    text, available = LEVEL_NOT_REACHED.format(int(level)), highest_level_up_to(level)
    if secret and available < assignment.level:
        return text  # its secret file is never used below the assignment's level
    if available is Level.LIMITED:
        return f"{text} To grade without it, use --level 0: a submitted program can then read and change anything that you can."
    return f"{text} To grade at level {int(available)}, use --level {int(available)}."
