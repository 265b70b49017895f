"""What an assignment grants programs: limits of a run and of a whole submission, as its sheet may set them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, Final

from grader.assignment import (
    DEFAULT_SUBMISSION_LIMIT_S,
    Trial,
)
from kit.host.sandbox.limits import GRADER_LIMITS, MIB, Limits
from kit.world.yaml_section import Section

SUBMISSION_KEY: Final = "submission"
MAX_SUBMISSION_LIMIT_S: Final = 4 * 3600.0
EPISODE_START_S: Final = 10.0
"""Wall clock granted to the start of each episode [s]."""
FIRST_EPISODES_S: Final = 120.0
"""Wall clock granted besides what the episodes may take [s]."""


@dataclass(frozen=True, slots=True)
class BudgetKey:
    """One key under ``budget``: a number of seconds, MiB or things."""

    name: str
    limit: str
    """Name of the field of ``Limits`` that it sets."""
    meaning: str
    """What it limits, with its unit, for teachers."""
    maximum: int
    minimum: int | None = None
    """None for seconds, which need only be above 0 and may have a fraction."""
    factor: int = 1
    """What one unit of it is in the field's unit."""

    def default(self, limits: Limits = GRADER_LIMITS) -> float:
        """Returns the limit among these, in the unit of the key."""
        return float(getattr(limits, self.limit)) / self.factor

    def read(self, section: Section, limits: Limits) -> Any:
        """Reads the field's value from the section; that of ``limits`` where the key is missing."""
        if self.minimum is None:
            return section.number(self.name, self.default(limits), above=0, maximum=self.maximum)
        default = int(self.default(limits))
        return self.factor * section.integer(self.name, default, minimum=self.minimum, maximum=self.maximum)


BUDGET_KEYS: Final = (
    BudgetKey("start", "start_s", "seconds until the program is loaded and waits", 120),
    BudgetKey("reply", "reply_s", "seconds until each reply", 60),
    BudgetKey("total", "total_s", "seconds of all waiting for replies, in one process", 3600),
    BudgetKey("cpu", "cpu_s", "seconds of processor time of one process", 3600, minimum=1),
    BudgetKey("memory", "memory", "MiB of memory of one process", 64 * 1024, minimum=256, factor=MIB),
    BudgetKey("disk", "scratch", "MiB of all files that it writes", 10 * 1024, minimum=1, factor=MIB),
    BudgetKey("files", "files", "files and folders that it writes", 10**6, minimum=10),
    BudgetKey("messages", "messages", "messages and requests that it sends in one tick", 10**6, minimum=1),
)
"""Every key but ``submission``, in the order in which they are listed for teachers."""


def read_budget(
    section: Section | None, trials: tuple[Trial, ...], usual: Limits = GRADER_LIMITS
) -> tuple[Limits, float]:
    """Reads the limits of each process, and the wall clock of the whole submission [s]. ``usual``: those of the assignment's
    kind, which hold where the section sets no others."""
    if section is None:
        return usual, default_submission_limit_s(trials, usual)
    limits = replace(usual, **{key.limit: key.read(section, usual) for key in BUDGET_KEYS})
    default = default_submission_limit_s(trials, limits)
    limit_s = section.number(SUBMISSION_KEY, default, above=0, maximum=MAX_SUBMISSION_LIMIT_S)
    section.finish()
    return limits, limit_s


def default_submission_limit_s(trials: tuple[Trial, ...], limits: Limits) -> float:
    """Returns the wall clock of one submission [s] by what its episodes may take.

    Each simulated second is granted a second of wall clock, of which it usually takes a tenth.
    """
    one_process_s = limits.start_wall_s + (limits.total_s or 0.0)
    if not trials:
        return max(DEFAULT_SUBMISSION_LIMIT_S, one_process_s)
    episodes_s = sum(
        (EPISODE_START_S + trial.time_s) * len((*trial.seeds, *trial.secret_seeds)) for trial in trials
    )
    return max(min(FIRST_EPISODES_S + episodes_s, DEFAULT_SUBMISSION_LIMIT_S), one_process_s)


def budget_lines() -> Iterator[tuple[str, str]]:
    """Yields each key with what it means and its default, for teachers."""
    for key in BUDGET_KEYS:
        yield key.name, f"{key.meaning}; {key.default():g} unless it or the kind sets another"
    longest = f"{DEFAULT_SUBMISSION_LIMIT_S:g}"
    meaning = (
        f"seconds of wall clock of the whole submission; by default what its episodes take, at most {longest}"
    )
    yield SUBMISSION_KEY, meaning
