"""The confinement level at which a verb runs programs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.cli.exits import fail

if TYPE_CHECKING:
    from grader.assignment import Assignment
    from kit.host.sandbox.sandbox_config import Level


def level_for_untrusted(
    assignment: Assignment, text: str | None, *, secret: bool, for_class: bool = False, runs_here: bool = True
) -> Level:
    """The confinement level at which programs of others are graded; exit code 2 if they run here and this machine does
    not reach it.

    ``text``: the option ``--level``. Without it, the level is the highest of this machine where secrets are used or a class
    is graded, and else the assignment's; at least 1 in any case.
    """
    from grader import grading_level
    from kit.host.sandbox.probe import highest_level_up_to
    from kit.host.sandbox.sandbox_config import Level

    level = grading_level.level_for_untrusted(assignment, to_level(text))
    if text is None and (secret or for_class):
        level = max(level, highest_level_up_to(Level.ANOTHER_USER))
    if runs_here and highest_level_up_to(level) < level:
        fail(grading_level.level_unavailable_text(assignment, level, secret=secret))
    return level


def to_level(text: str | None) -> Level | None:
    """Returns the level that was asked for; None where none was. ``highest``: of this machine, but never below 1."""
    from kit.host.sandbox.probe import highest_level_up_to
    from kit.host.sandbox.sandbox_config import Level

    if text == "highest":
        return max(Level.FILTERED, highest_level_up_to(Level.ANOTHER_USER))
    return None if text is None else Level(int(text))
