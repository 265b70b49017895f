"""What trainings for a printed table came to, as an event log of a few kB, and the numbers that follow from it.

A log is a text file of one JSON object a line: first how the agents were trained and on which machine, then a line for
each agent that was tested. Lines are only added, so that a log can be taken up again.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import fmean, pstdev

from kit.learning.policies.confidence_intervals import ConfidenceInterval, wilson_interval
from kit.study.printed_tables import ADJACENCY, SUCCESS, PrintedTable
from kit.workspace import Workspace


class RecordedResultError(Exception):
    """A log that cannot be read; the message names the file and the line."""


@dataclass(frozen=True, slots=True)
class RecordedSettings:
    """How all agents of a log were trained and tested."""

    table: str
    task: str
    algorithm: str
    preset: str
    episodes: int
    """Of each case."""
    steps: int | None
    """At most, of each training; None: as the preset says."""
    versions: Mapping[str, str]
    """Of packages, Python and the machine."""


@dataclass(frozen=True, slots=True)
class RecordedTest:
    """One agent's test on all cases."""

    group: str
    """The cases that it was trained on."""
    seed: int
    steps: int
    seconds: float
    """That its training took."""
    episodes: int
    """Of each case."""
    reached: Mapping[str, int]
    """By case: episodes that reached the target."""
    adjacency: Mapping[str, float]
    """By case: the share of steps in which two robots were side by side, by rays. Empty for one robot."""


@dataclass(frozen=True, slots=True)
class RecordedCell:
    """A number that stands against a printed one."""

    value: float
    interval: ConfidenceInterval | None
    """The 95 % interval (Wilson) of a share of successes; None for other numbers."""


@dataclass(frozen=True, slots=True)
class RecordedResult:
    """A log that has been read."""

    file: Path
    settings: RecordedSettings
    tests: tuple[RecordedTest, ...]

    def has_test(self, group: str, seed: int) -> bool:
        return any((each.group, each.seed) == (group, seed) for each in self.tests)

    def tests_of(self, group: str) -> tuple[RecordedTest, ...]:
        return tuple(each for each in self.tests if each.group == group)

    @property
    def rate(self) -> float | None:
        """Steps per second of training, of all agents together; None if none was timed."""
        seconds = sum(each.seconds for each in self.tests)
        return sum(each.steps for each in self.tests) / seconds if seconds else None

    def cells(self, table: PrintedTable) -> dict[tuple[str, str], RecordedCell]:
        """The numbers that stand against those of ``table``, by row and column: cases, and the rows mean and SD."""
        found: dict[tuple[str, str], RecordedCell] = {}
        for column, group, measure in zip(table.columns, table.groups, table.measures, strict=True):
            tests = self.tests_of(group)
            own = {}
            for row, (_, case) in zip(table.rows, table.cases, strict=False):
                if (cell := _case_cell(tests, case, measure)) is not None:
                    own[row] = cell
            values = [cell.value for cell in own.values()]
            if len(values) == len(table.cases):
                own |= {"mean": RecordedCell(fmean(values), None), "SD": RecordedCell(pstdev(values), None)}
            found |= {(row, column): cell for row, cell in own.items() if row in table.rows}
        return found


def _case_cell(tests: tuple[RecordedTest, ...], case: str, measure: str) -> RecordedCell | None:
    """Of all seeds together; None if nothing was measured."""
    if measure == ADJACENCY:
        shares = [each.adjacency[case] for each in tests if case in each.adjacency]
        return RecordedCell(fmean(shares), None) if shares else None
    assert measure == SUCCESS
    tested = [each for each in tests if case in each.reached]
    episodes, reached = sum(each.episodes for each in tested), sum(each.reached[case] for each in tested)
    return RecordedCell(reached / episodes, wilson_interval(reached, episodes)) if episodes else None


def recorded_result_file(workspace: Workspace, table: str) -> Path:
    return workspace.folder / "study" / f"{table}.jsonl"


def read_recorded_result(file: Path) -> RecordedResult | None:
    """None if there is no such file. RecordedResultError; a last line that was cut off is left out."""
    try:
        lines = file.read_text(encoding="utf-8").splitlines(keepends=True)
    except FileNotFoundError:
        return None
    except (OSError, UnicodeDecodeError) as error:
        raise RecordedResultError(f"{file}: cannot be read ({error}).") from None
    whole = [line for line in lines if line.endswith("\n")]
    if not whole:
        return None
    settings, *tests = [_read_line(file, number, line) for number, line in enumerate(whole, 1)]
    if not isinstance(settings, RecordedSettings) or not all(
        isinstance(each, RecordedTest) for each in tests
    ):
        raise RecordedResultError(f"{file}: must begin with one line of settings. Delete or rename it.")
    return RecordedResult(file, settings, tuple(each for each in tests if isinstance(each, RecordedTest)))


def _read_line(file: Path, number: int, line: str) -> RecordedSettings | RecordedTest:
    try:
        content = json.loads(line)
        event = content.pop("event")
        if event == "settings":
            return RecordedSettings(**content)
        test = RecordedTest(**content)
        counts = [test.steps, test.episodes, *test.reached.values()]
        numbers = [test.seconds, *test.adjacency.values()]
        if event != "tested" or not all(type(each) is int and each >= 0 for each in counts):
            raise ValueError("a count is wrong")
        if not all(math.isfinite(each) for each in numbers):
            raise ValueError("a number is not finite")
        if any(reached > test.episodes for reached in test.reached.values()):
            raise ValueError("more successes than episodes")
    except (ValueError, TypeError, KeyError, AttributeError) as error:
        raise RecordedResultError(
            f"{file}, line {number}: no event of a study ({error}). Delete the line or the file."
        ) from None
    return test


def append_event(file: Path, event: RecordedSettings | RecordedTest) -> None:
    """Adds a line. Raises OSError."""
    name = "settings" if isinstance(event, RecordedSettings) else "tested"
    file.parent.mkdir(parents=True, exist_ok=True)
    text = file.read_bytes() if file.exists() else b""
    if text and not text.endswith(b"\n"):  # a process was killed while it wrote
        file.write_bytes(text[: text.rfind(b"\n") + 1])
    with file.open("a", encoding="utf-8") as log:
        log.write(json.dumps({"event": name, **asdict(event)}) + "\n")
