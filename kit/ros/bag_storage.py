"""How a bag lies on the disk: its kinds of storage, the part that is written while it is recorded, and its restoration.

``.NAME.part`` is a folder beside NAME: the bag as its library writes it, ``topics`` with what its files do not say until
they are complete, and ``lock``, which the program that records keeps. The bag's file is ``NAME_0.mcap`` or ``NAME_0.db3``,
as ROS 2 calls the first of several; its library names it after its folder, which is ``NAME_0`` until it is complete.
"""

from __future__ import annotations

import json
import shutil
import sqlite3
import struct
from collections.abc import Iterator
from contextlib import closing, suppress
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any, BinaryIO, Final, Literal

from rosbags.interfaces import Connection, ConnectionExtRosbag2
from rosbags.rosbag2 import ReaderError, StoragePlugin, Writer, WriterError
from rosbags.rosbag2.storage_mcap import McapReader, McapWriter
from rosbags.rosbag2.storage_sqlite3 import Sqlite3Reader, Sqlite3Writer

from kit.part_file import BeingWrittenError, lock_part, part_path, parts_in, path_of_part, unused_path
from kit.plain_text import counted
from kit.ros.serialization import Distro

Storage = Literal["mcap", "sqlite3"]

LOCK_FILE: Final = "lock"
TOPICS_FILE: Final = "topics"

MCAP_MAGIC: Final = b"\x89MCAP0\r\n"
RECORD_HEAD: Final = struct.Struct("<BQ")
"""Of a record of MCAP: its kind, and the bytes that follow (https://mcap.dev/spec)."""
FOOTER, DATA_END = 0x02, 0x0F
MCAP_END: Final = (
    RECORD_HEAD.pack(DATA_END, 4) + bytes(4) + RECORD_HEAD.pack(FOOTER, 20) + bytes(20) + MCAP_MAGIC
)
"""The end of a file without an index."""

WRITE_ERRORS: Final = (OSError, sqlite3.Error, WriterError)
"""What writing a bag raises."""


class BagError(OSError):
    """A bag that cannot be read or written; the message says which and why."""


@dataclass(frozen=True, slots=True)
class StorageSettings:
    """The settings of a kind of storage: files are written for the oldest ROS 2 that reads it without plugins."""

    plugin: StoragePlugin
    version: Literal[8, 9]
    distro: Distro


STORAGE_SETTINGS: Final = MappingProxyType(
    {
        "mcap": StorageSettings(StoragePlugin.MCAP, 9, "jazzy"),
        "sqlite3": StorageSettings(StoragePlugin.SQLITE3, 8, "humble"),
    }
)


class BagPart:
    """A bag that is being written, until ``complete`` gives it its name.

    Raises BagError if it cannot be written, and BeingWrittenError if another program records a bag of this name.
    """

    def __init__(self, folder: Path, storage: Storage) -> None:
        self._folder = folder
        self._settings = STORAGE_SETTINGS[storage]
        self._part = part_path(folder)
        self._lock: BinaryIO | None = None
        self._torn = False
        """Whether half a record may have been written."""
        try:
            self._part.mkdir(parents=True, exist_ok=True)  # as ROS 2 does
            self._lock = lock_part(self._part / LOCK_FILE, folder)
            self._writer = _open_writer(self._part / first_file(folder), self._settings)
            self._topics = (self._part / TOPICS_FILE).open("a", encoding="utf-8")
        except BeingWrittenError:
            raise
        except WRITE_ERRORS as problem:
            if self._lock is not None:
                self._lock.close()
            raise BagError(f"{folder}: no bag can be written there ({reason(problem)}).") from None

    def add_topic(
        self, topic: str, type_name: str, definition: str, type_hash: str, profiles: list[Any]
    ) -> Connection:
        """Begins a topic. Raises one of WRITE_ERRORS."""
        self._topics.write(json.dumps([topic, type_hash]) + "\n")
        self._topics.flush()
        return self._writer.add_connection(
            topic, type_name, msgdef=definition, rihs01=type_hash, offered_qos_profiles=profiles
        )

    def write(self, connection: Connection, time_ns: int, data: bytes) -> None:
        """Writes one message. Raises one of WRITE_ERRORS; nothing may be written afterwards."""
        place = self._place()
        try:
            self._writer.write(connection, time_ns, data)
        except WRITE_ERRORS:
            self._torn = self._place() != place
            raise

    def flush(self) -> None:
        """Puts all messages on the disk, where a later kill does not lose them. Raises one of WRITE_ERRORS."""
        storage = self._writer.storage
        if isinstance(storage, Sqlite3Writer):
            storage.conn.commit()
        elif isinstance(storage, McapWriter) and not self._torn and storage.chunk.bio.tell():
            self._torn = True
            storage.close_chunk()
            storage.bio.flush()
            self._torn = False

    def complete(self) -> None:
        """Writes the index and the summary, and gives the bag its name. Raises one of WRITE_ERRORS."""
        self._writer.close()
        self._writer.path.rename(self._folder)
        self._remove()

    def rescue(self) -> int:
        """Makes a bag, after an error, of what has been written, without what was being written. Returns its number of
        messages. Raises BagError, and then the part stays, for the next start."""
        with suppress(*WRITE_ERRORS):
            self.flush()
        with suppress(*WRITE_ERRORS):
            self._writer.abort()
        try:
            count = _rewrite(self._part, self._folder)
        except (*WRITE_ERRORS, ReaderError, ValueError) as problem:
            self._close()
            raise BagError(
                f"{self._folder}: the bag could not be completed ({reason(problem)}). What there is of it is kept; "
                f"`kit ros bag info {self._folder}` restores it once there is space."
            ) from None
        self._remove()
        return count

    def _place(self) -> int:
        """How far the file has been written, as far as that can be known."""
        storage = self._writer.storage
        return storage.bio.tell() if isinstance(storage, McapWriter) else 0

    def _remove(self) -> None:
        shutil.rmtree(self._part, ignore_errors=True)
        self._close()

    def _close(self) -> None:
        with suppress(OSError):
            self._topics.close()
        if self._lock is not None:
            self._lock.close()


def restore_bags(folder: Path, wanted: Path | None = None) -> Iterator[str]:
    """Completes all bags in a folder that killed programs have left, and yields a sentence for each.

    ``wanted``: a name that is to stay free. What another program records now is left alone; so is what cannot be restored, of which the sentence says why.
    """
    for part in parts_in(folder):
        if part.is_dir() and (part / LOCK_FILE).is_file() and (notice := _restore(part, wanted)):
            yield notice


def is_being_recorded(folder: Path) -> bool:
    """Whether a program records a bag of this name now."""
    lock = part_path(folder) / LOCK_FILE
    if lock.is_file():
        try:
            lock_part(lock, folder).close()
        except BeingWrittenError:
            return True
        except OSError:
            return False
    return False


def _restore(part: Path, wanted: Path | None) -> str:
    folder = path_of_part(part)
    try:
        with lock_part(part / LOCK_FILE, folder):
            restored = unused_path(folder, wanted)
            count = _rewrite(part, restored)
            shutil.rmtree(part)
    except BeingWrittenError:
        return ""
    except (*WRITE_ERRORS, ReaderError, ValueError) as problem:
        return f"{part}: what a recording that was killed has left cannot be restored ({reason(problem)})."
    return (
        f"{restored}: restored from a recording that was killed; {counted(count, 'message')} kept."
        if count
        else ""
    )


def _rewrite(part: Path, folder: Path) -> int:
    """Writes a bag of all whole messages of a part; returns their number. Where there is none, there is no bag.

    Raises one of WRITE_ERRORS, ReaderError or ValueError; then nothing has changed.
    """
    written = next(
        (
            path
            for path in part.glob(f"{first_file(path_of_part(part))}/*")
            if path.suffix in (".mcap", ".db3")
        ),
        None,
    )
    if written is None:
        return 0
    hashes: dict[str, str] = {}
    with suppress(FileNotFoundError, ValueError):  # the last line was being written
        for line in (part / TOPICS_FILE).read_text("utf-8").splitlines():
            topic, type_hash = json.loads(line)
            hashes[topic] = type_hash
    reader = _repaired(written)
    if reader is None:
        return 0
    count = 0
    new = part / "restored" / first_file(folder)
    shutil.rmtree(new.parent, ignore_errors=True)
    try:
        reader.open()
        with closing(reader):
            connections = list(reader.connections)
            settings = STORAGE_SETTINGS["mcap" if written.suffix == ".mcap" else "sqlite3"]
            writer = _open_writer(new, settings)
            targets = {}
            for each in connections:
                assert isinstance(each.ext, ConnectionExtRosbag2)
                targets[each.id] = writer.add_connection(
                    each.topic,
                    each.msgtype,
                    msgdef=each.msgdef.data,
                    rihs01=hashes.get(each.topic, each.digest),
                    serialization_format=each.ext.serialization_format,
                    offered_qos_profiles=each.ext.offered_qos_profiles,
                )
            if connections:
                for connection, time_ns, data in reader.messages(connections):
                    writer.write(targets[connection.id], time_ns, data)
                    count += 1
            writer.close()
        if count:
            new.rename(folder)
    finally:
        shutil.rmtree(new.parent, ignore_errors=True)
    return count


def _repaired(file: Path) -> McapReader | Sqlite3Reader | None:
    """A reader for a file of a bag that was not completed, after what was being written is cut off; None where nothing is
    in it."""
    if file.suffix == ".db3":
        with closing(sqlite3.connect(file)) as opened:  # rolls back what was not committed
            tables = opened.execute("SELECT count(*) FROM sqlite_master WHERE name = 'messages'").fetchone()
        return Sqlite3Reader(file) if tables[0] else None
    with file.open("r+b") as data:
        size = data.seek(0, 2)
        data.seek(0)
        if data.read(len(MCAP_MAGIC)) != MCAP_MAGIC:
            return None
        end = len(MCAP_MAGIC)
        while end + RECORD_HEAD.size <= size:
            data.seek(end)
            kind, length = RECORD_HEAD.unpack(data.read(RECORD_HEAD.size))
            after = end + RECORD_HEAD.size + length
            if after > size or kind in (DATA_END, FOOTER):
                break
            end = after
        data.truncate(end)
        data.seek(end)
        data.write(MCAP_END)
    return McapReader(file) if end > len(MCAP_MAGIC) else None


def first_file(folder: Path) -> str:
    """The name of the first file of a bag, without its ending."""
    return f"{folder.name}_0"


def _open_writer(folder: Path, settings: StorageSettings) -> Writer:
    folder.parent.mkdir(exist_ok=True)
    writer = Writer(folder, version=settings.version, storage_plugin=settings.plugin)
    writer.open()
    return writer


def reason(problem: Exception) -> str:
    """What an error says, without the path."""
    return (problem.strerror if isinstance(problem, OSError) else None) or str(problem)
