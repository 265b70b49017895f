"""Reads the file into which a student's progress was exported."""

from __future__ import annotations

import json
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Final

from kit.plain_files import nearest_file, read_plain_file
from kit.school.progress import FORMAT, VERSION, YEARS, EventKind, ProgressError, ProgressEvent

MAX_EXPORT_BYTES: Final = 5_000_000
"""Bytes of an exported file: many times what a student does in a year; reading takes ten times as much memory."""


def read_export(file: Path) -> list[ProgressEvent]:
    """Reads the events of an exported file. Raises ProgressError if it is malformed."""
    try:
        content = json.loads(read_plain_file(file, MAX_EXPORT_BYTES).decode())
    except OSError as error:
        near = nearest_file(file) if isinstance(error, FileNotFoundError) else ""
        hint = f" Did you mean {near}?" if near else ""
        raise ProgressError(f"{file}: cannot be read ({error.strerror}).{hint}") from None
    except (ValueError, RecursionError) as error:
        raise ProgressError(f"{file}: is not an export of progress, or is cut off ({error}).") from None
    if (
        not isinstance(content, dict)
        or content.get("format") != FORMAT
        or not isinstance(content.get("events"), list)
    ):
        raise ProgressError(f"{file}: is not an export of progress; `kit progress export FILE` makes one.")
    if content.get("version") != VERSION:
        raise ProgressError(
            f"{file}: is of version {content.get('version')}; this kit reads version {VERSION}."
        )
    return [_event_from_export(each, index, file) for index, each in enumerate(content["events"], 1)]


def _event_from_export(content: Any, index: int, file: Path) -> ProgressEvent:
    try:
        event = ProgressEvent(
            str(content["uid"]),
            _to_utc_text(str(content["at"])),
            EventKind(content["kind"]),
            str(content["subject"]),
            dict(content["content"]),
        )
    except (KeyError, TypeError, ValueError, OverflowError) as error:
        raise ProgressError(f"{file}: entry {index} cannot be understood ({error!r}).") from None
    return event


def _to_utc_text(at: str) -> str:
    """Converts a time to the journal's format, in which texts sort like times."""
    time = datetime.fromisoformat(at)
    if time.tzinfo is None:
        raise ValueError("a time without its zone")
    if (
        time.year not in YEARS
    ):  # what is computed from it, such as when a question is due again, must be a time too
        raise ValueError("a time of another century")
    return time.astimezone(UTC).isoformat(timespec="microseconds")
