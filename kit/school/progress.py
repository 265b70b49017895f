"""The student's progress: an append-only journal of events, in ``progress.db`` of the workspace.

All progress on display (completed lessons, stars, the next question) is computed from these events, so that nothing
can contradict them. An event is on the disk when ``add`` returns, and no later kill loses it. A damaged file is set
aside, never overwritten, and its readable events are copied to the new one.
"""

from __future__ import annotations

import json
import math
import os
import sqlite3
import threading
import uuid
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import closing, suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from enum import StrEnum
from pathlib import Path
from typing import Any, Final, Self

from kit.plain_text import counted
from kit.workspace import write_atomically

FILE: Final = "progress.db"
FORMAT: Final = "robot-learning-kit progress"
VERSION: Final = 1

LOCK_TIMEOUT_S: Final = 10.0
"""Seconds to wait for another process of the same student that is writing."""

MAX_CONTENT_LENGTH: Final = 64 * 1024
"""Characters of one event's content: a student's answer fits, a file that was read by mistake does not."""

_SCHEMA: Final = """
CREATE TABLE IF NOT EXISTS events (
    number INTEGER PRIMARY KEY AUTOINCREMENT,
    uid TEXT NOT NULL UNIQUE,
    at TEXT NOT NULL,
    kind TEXT NOT NULL,
    subject TEXT NOT NULL,
    content TEXT NOT NULL
)
"""
_ALL: Final = "SELECT uid, at, kind, subject, content FROM events"
_Row = tuple[str, str, str, str, str]


class ProgressError(Exception):
    """Progress cannot be read or written; the message says why and what to do."""


class EventKind(StrEnum):
    """The kind of an event."""

    STEP = "step"
    PREDICTION = "prediction"
    ATTEMPT = "attempt"
    HINT = "hint"
    SOLUTION = "solution"
    ANSWER = "answer"
    FORM = "form"
    START = "start"
    FINISH = "finish"
    ABOUT = "about"
    DEFENCE = "defence"
    NEWS = "news"
    TAG = "tag"


YEARS: Final = range(2000, 2100)
"""Years in which something can have been recorded."""


@dataclass(frozen=True, slots=True)
class ProgressEvent:
    """One recorded event."""

    uid: str
    """Globally unique: the same event imported twice is stored once."""
    timestamp: str
    """UTC, ISO 8601 with microseconds."""
    kind: EventKind
    subject: str
    """The id of a lesson's step, an exercise, a quiz item or a level."""
    content: Mapping[str, Any]
    """JSON values."""

    @property
    def time(self) -> datetime:
        return datetime.fromisoformat(self.timestamp)

    def number(self, key: str) -> float | None:
        """A finite number of the content; None for anything else, since an imported file may hold anything."""
        value = self.content.get(key)
        if isinstance(value, bool) or not isinstance(value, int | float):
            return None
        try:
            number = float(value)
        except OverflowError:
            return None
        return number if math.isfinite(number) else None

    def text(self, key: str) -> str:
        """A printable text of the content; empty for anything else."""
        value = self.content.get(key)
        return value if isinstance(value, str) and value.isprintable() else ""


class ProgressJournal:
    """The journal of one student. Every method raises ProgressError where the disk refuses."""

    def __init__(self, folder: Path) -> None:
        self._file = folder / FILE
        self._using = threading.Lock()
        """Held while the connection is used: SQLite crashes if it is closed meanwhile, and a transaction is one thread's."""
        self.notice = ""
        """Message for the student about a damaged file found at opening; else empty."""
        try:
            self._connection = self._open_file()
            self._check_database()
        except sqlite3.OperationalError as error:
            raise self._unusable_error(error) from None
        except sqlite3.DatabaseError:
            self._set_aside()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Closes the file; waits for the threads that use it. What they do afterwards raises ProgressError."""
        with self._using:
            self._connection.close()

    def add(
        self,
        kind: EventKind,
        subject: str,
        content: Mapping[str, Any] | None = None,
        *,
        now: datetime | None = None,
    ) -> ProgressEvent:
        """Appends one event. It is on the disk when this returns."""
        at = (now or datetime.now(UTC)).astimezone(UTC).isoformat(timespec="microseconds")
        event = ProgressEvent(uuid.uuid4().hex, at, kind, subject, dict(content or {}))
        self._write_events([event])
        return event

    @property
    def student_name(self) -> str:
        """The name that the student gave last; empty if none."""
        names = [name for event in self.events(EventKind.ABOUT, "name") if (name := event.text("value"))]
        return names[-1] if names else ""

    def events(self, kind: EventKind | None = None, subject: str | None = None) -> list[ProgressEvent]:
        """Returns the events in the order of their time, all or those of one kind or subject."""
        filters = [("kind", kind), ("subject", subject)]
        conditions = " AND ".join(f"{column} = ?" for column, value in filters if value is not None)
        query = f"{_ALL} WHERE {conditions}" if conditions else _ALL
        try:
            with self._using:
                rows = self._connection.execute(
                    f"{query} ORDER BY at, number", [str(value) for _, value in filters if value is not None]
                ).fetchall()
            return [event for row in rows if (event := _event_from_row(row)) is not None]
        except sqlite3.Error as error:
            raise self._unusable_error(error) from None

    def export(self, file: Path) -> int:
        """Writes all events to one file, atomically. Returns the number of events."""
        events = self.events()
        content = {
            "format": FORMAT,
            "version": VERSION,
            "events": [
                {
                    "uid": each.uid,
                    "at": each.timestamp,
                    "kind": each.kind.value,
                    "subject": each.subject,
                    "content": each.content,
                }
                for each in events
            ],
        }
        try:
            write_atomically(
                file.absolute(), (json.dumps(content, indent=1, ensure_ascii=False) + "\n").encode()
            )
        except OSError as error:
            raise ProgressError(f"{file}: cannot be written ({error.strerror}).") from None
        return len(events)

    def import_events(self, events: Iterable[ProgressEvent]) -> int:
        """Adds events of another journal, all or none, and skips known ones. Returns the number of new events."""
        return self._write_events(events)

    def _write_events(self, events: Iterable[ProgressEvent]) -> int:
        rows = [_row_from_event(each) for each in events]
        too_long = next((row for row in rows if len(row[4]) > MAX_CONTENT_LENGTH), None)
        if too_long is not None:
            raise ProgressError(
                f"{too_long[3]}: {len(too_long[4])} characters are too many; {MAX_CONTENT_LENGTH} fit."
            )
        try:
            with self._using:
                try:
                    return _insert_rows(self._connection, rows)
                except sqlite3.OperationalError:
                    if not self._has_moved():
                        raise
                    self._restore_file()
                    return _insert_rows(self._connection, rows)
        except sqlite3.Error as error:
            raise self._unusable_error(error) from None

    def _has_moved(self) -> bool:
        """Whether the opened file was deleted, moved or replaced."""
        return _file_identity(self._file) != self._opened

    def _restore_file(self) -> None:
        """Copies the events of the deleted file, which exists for as long as it is open, to a new file in its place."""
        rows = self._connection.execute(_ALL).fetchall()
        self._connection.close()
        self._connection = self._open_file()
        _insert_rows(self._connection, rows)

    def _open_file(self) -> sqlite3.Connection:
        connection = _open_connection(self._file)
        self._opened = _file_identity(self._file)
        return connection

    def _check_database(self) -> None:
        check_result = self._connection.execute("PRAGMA quick_check(1)").fetchone()
        columns = {row[1] for row in self._connection.execute("PRAGMA table_info(events)")}
        if check_result != ("ok",) or not {"uid", "at", "kind", "subject", "content"} <= columns:
            raise sqlite3.DatabaseError("damaged")

    def _set_aside(self) -> None:
        """Keeps the damaged file under another name and continues with the events that can be read from it.

        At every instant the file in its place is the damaged one or the whole new one, so that a kill loses nothing.
        """
        with suppress(AttributeError):
            self._connection.close()
        stamp = datetime.now(UTC).strftime("%Y%m%d-%H%M%S-%f")
        backup = self._file.with_name(f"{self._file.stem}.damaged-{stamp}{self._file.suffix}")
        fresh = self._file.with_name(f".{self._file.name}.{stamp}")
        try:
            identity = _file_identity(self._file)
            saved = [_row_from_event(event) for event in _salvaged_events(self._file)]
            with closing(_open_connection(fresh)) as connection:
                _insert_rows(connection, saved)
            if _file_identity(self._file) == identity:  # else another process has repaired it meanwhile
                _keep_as(self._file, backup)
                fresh.replace(self._file)
            self._connection = self._open_file()
        except (OSError, sqlite3.Error) as error:
            raise self._unusable_error(error) from None
        finally:
            for left in (fresh, Path(f"{fresh}-journal")):
                with suppress(OSError):
                    left.unlink()
        self.notice = (
            f"{self._file.name} was damaged. It was saved as {backup.name}; "
            f"{counted(len(saved), 'event')} could be read from it and kept."
        )

    def _unusable_error(self, error: Exception) -> ProgressError:
        if isinstance(error, sqlite3.DatabaseError) and not isinstance(error, sqlite3.OperationalError):
            return ProgressError(
                f"{self._file}: was just damaged ({error}). Start again: the readable events are kept."
            )
        return ProgressError(
            f"{self._file}: progress cannot be saved there ({error}). "
            "Is the disk full, or the folder another user's? `--workspace FOLDER` names another."
        )


def _open_connection(file: Path) -> sqlite3.Connection:
    # Readable by its owner alone, wherever the workspace lies; SQLite gives its journal the same mode.
    with suppress(OSError):  # SQLite says what is wrong
        os.close(os.open(file, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600))
        file.chmod(0o600)
    # Several threads of a screen may use it, one at a time.
    connection = sqlite3.connect(file, timeout=LOCK_TIMEOUT_S, check_same_thread=False)
    try:
        # Not the write-ahead log: it needs shared memory, which network homes do not have.
        connection.execute("PRAGMA synchronous = FULL")
        connection.execute(_SCHEMA)
        connection.commit()
    except sqlite3.Error:
        connection.close()
        raise
    return connection


def _insert_rows(connection: sqlite3.Connection, rows: Sequence[_Row]) -> int:
    """Adds rows, all or none. Returns how many are new."""
    with connection:
        before = connection.total_changes
        connection.executemany(
            "INSERT OR IGNORE INTO events (uid, at, kind, subject, content) VALUES (?, ?, ?, ?, ?)", rows
        )
    return connection.total_changes - before


def _file_identity(file: Path) -> tuple[int, int] | None:
    """Device and inode of the file that is there now; None if there is none."""
    try:
        status = file.stat()
    except OSError:
        return None
    return status.st_dev, status.st_ino


def _keep_as(file: Path, backup: Path) -> None:
    """Gives the file, and those that SQLite keeps beside it, another name; the old name stays where links can be made."""
    try:
        os.link(file, backup)
    except OSError:
        file.replace(backup)
    for ending in ("-journal", "-wal", "-shm"):
        with suppress(FileNotFoundError):
            os.replace(f"{file}{ending}", f"{backup}{ending}")  # noqa: PTH105 - the names are text with an ending


def _row_from_event(event: ProgressEvent) -> _Row:
    content = json.dumps(dict(event.content), ensure_ascii=False)
    return event.uid, event.timestamp, event.kind.value, event.subject, content


def _event_from_row(row: _Row) -> ProgressEvent | None:
    """The event of a row; None for a row of an unknown kind, such as a newer kit's, which stays in the file."""
    uid, at, kind, subject, content = row
    try:
        event = ProgressEvent(uid, at, EventKind(kind), subject, json.loads(content))
        is_whole = isinstance(event.content, dict) and event.time.tzinfo is not None
    except (TypeError, ValueError, RecursionError):
        return None
    return event if is_whole else None


def _salvaged_events(file: Path) -> Iterator[ProgressEvent]:
    """Yields the events that can be read from a damaged file, row by row from both ends."""
    seen: set[int] = set()
    with suppress(sqlite3.Error), closing(sqlite3.connect(file, timeout=LOCK_TIMEOUT_S)) as connection:
        for order in ("ASC", "DESC"):
            with suppress(sqlite3.Error, UnicodeDecodeError):
                for number, *row in connection.execute(
                    f"SELECT number, uid, at, kind, subject, content FROM events ORDER BY number {order}"
                ):
                    if number in seen:
                        break
                    seen.add(number)
                    event = _event_from_row(tuple(row))
                    if event is not None:
                        yield event
