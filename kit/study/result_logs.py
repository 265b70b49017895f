"""Logs of recorded results: where they are, how they are read and written."""

from __future__ import annotations

import json
import math
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final

from kit.line_log import MAX_READ_BYTES, LineLog
from kit.plain_files import read_plain_file
from kit.study.printed_tables import (
    PrintedTable,
)
from kit.study.recorded_results import (
    OUTCOMES,
    Event,
    RecordedPath,
    RecordedResult,
    RecordedResultError,
    RecordedSettings,
    RecordedTest,
    TrainingSession,
)
from kit.study.study_variants import VARIANTS, StudyVariant
from kit.workspace import Workspace

SHIPPED_FOLDER: Final = Path(__file__).with_name("results")
"""The logs that come with the kit."""
EVENT_NAMES: Final = {RecordedSettings: "settings", RecordedTest: "tested", RecordedPath: "path"}


def log_name(table: str, variant: StudyVariant = "seed") -> str:
    """The name of a table's log, without its ending.

    >>> log_name("3.5"), log_name("3.5", "kit")
    ('3.5', '3.5-kit')
    """
    return table if variant == "seed" else f"{table}-{variant}"


def recorded_result_file(workspace: Workspace, table: str, variant: StudyVariant = "seed") -> Path:
    """The log of a workspace."""
    return workspace.folder / "study" / f"{log_name(table, variant)}.jsonl"


def source_number(table: PrintedTable) -> str:
    """The number of the table whose agents stand against a printed one."""
    return table.results_of or table.id


def find_recorded_result(
    workspace: Workspace | None, table: PrintedTable, variant: StudyVariant = "seed"
) -> RecordedResult | None:
    """The workspace's result for a table; else the one that comes with the kit; None if there is neither.

    Raises RecordedResultError.
    """
    number = source_number(table)
    own = (
        None if workspace is None else read_recorded_result(recorded_result_file(workspace, number, variant))
    )
    return own or read_recorded_result(SHIPPED_FOLDER / f"{log_name(number, variant)}.jsonl")


def find_recorded_results(
    table: PrintedTable, workspace: Workspace | None
) -> dict[StudyVariant, RecordedResult]:
    """Returns the results of a table's trainings that there are, by variant. Raises RecordedResultError."""
    found = {variant: find_recorded_result(workspace, table, variant) for variant in VARIANTS}
    return {variant: result for variant, result in found.items() if result is not None}


def read_recorded_result(file: Path) -> RecordedResult | None:
    """None if there is no such file. RecordedResultError; a last line that was cut off is left out."""
    try:
        lines = read_plain_file(file, MAX_READ_BYTES).decode().splitlines(keepends=True)
    except FileNotFoundError:
        return None
    except (OSError, UnicodeDecodeError) as error:
        raise RecordedResultError(f"{file}: cannot be read ({error}).") from None
    whole = [line for line in lines if line.endswith("\n")]
    if not whole:
        return None
    settings, *others = [_read_line(file, number, line) for number, line in enumerate(whole, 1)]
    if not isinstance(settings, RecordedSettings) or any(
        isinstance(each, RecordedSettings) for each in others
    ):
        raise RecordedResultError(f"{file}: must begin with one line of settings. Delete or rename it.")
    tests = tuple(each for each in others if isinstance(each, RecordedTest))
    return RecordedResult(
        file, settings, tests, tuple(each for each in others if isinstance(each, RecordedPath))
    )


def _read_line(file: Path, number: int, line: str) -> Event:
    try:
        content = json.loads(line)
        event = content.pop("event")
        if event == "settings":
            return RecordedSettings(**content)
        if event == "path":
            return _read_path(content)
        content["own_cases"] = tuple(content["own_cases"])
        content["sessions"] = tuple(TrainingSession(*each) for each in content["sessions"])
        test = RecordedTest(**content)
        counts = [test.steps, test.episodes, *test.reached.values()]
        counts += [count for each in test.sessions for count in each[:4]]
        numbers = [
            test.seconds,
            *test.adjacency.values(),
            *test.adjacency_sd.values(),
            *test.by_poses.values(),
            *test.reached_by_rays.values(),
            *test.reached_by_poses.values(),
        ]
        if event != "tested" or not all(type(each) is int and each >= 0 for each in counts):
            raise ValueError("a count is wrong")
        if not all(math.isfinite(each) for each in numbers):
            raise ValueError("a number is not finite")
        if any(reached > test.episodes for reached in test.reached.values()):
            raise ValueError("more successes than episodes")
    except (ValueError, TypeError, KeyError, AttributeError, OverflowError, RecursionError) as error:
        raise RecordedResultError(
            f"{file}, line {number}: no event of a study ({error}). Delete the line or the file."
        ) from None
    return test


def _read_path(content: dict[str, Any]) -> RecordedPath:
    """ValueError, TypeError or KeyError."""
    x, y = content.pop("target")
    places = tuple(tuple((float(x), float(y)) for x, y in robot) for robot in content.pop("places"))
    path = RecordedPath(**content, target=(float(x), float(y)), places=places)
    if path.outcome not in OUTCOMES:
        raise ValueError(f"no outcome {path.outcome!r}")
    numbers = [path.interval, x, y, *(number for robot in places for place in robot for number in place)]
    if not all(math.isfinite(each) for each in numbers) or path.interval <= 0:
        raise ValueError("a number is not finite")
    if not places or not all(places) or len(set(map(len, places))) > 1:
        raise ValueError("robots have not as many places each")
    return path


def append_event(file: Path, event: Event) -> None:
    """Adds a line. Raises OSError."""
    name = EVENT_NAMES[type(event)]
    file.parent.mkdir(parents=True, exist_ok=True)
    with file.open("a+b") as opened:
        LineLog(opened).append(json.dumps({"event": name, **asdict(event)}).encode())
