"""Writes and reads bags message by message, as ``rosbag2_py`` does: messages are bytes in CDR.

A bag is written as a recording is (``kit.ros.bag_storage``): it has its name when it is complete, which the writer's end, its
``close`` or the program's end sees to. Facts of the classes: https://github.com/ros2/rosbag2/tree/rolling/rosbag2_py.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from enum import IntEnum
from pathlib import Path
from typing import Final, cast
from weakref import finalize

from rosbags.interfaces import Connection
from rosbags.rosbag2 import Reader

from kit.msg.interfaces import UnknownInterface, find_message
from kit.ros.bag_storage import (
    STORAGE_SETTINGS,
    WRITE_ERRORS,
    BagError,
    BagPart,
    Storage,
    reason,
    restore_bags,
)
from kit.ros.bags import Bag, BagTopic, offered_profile, open_reader, read_bag
from kit.ros.node.qos import QoSProfile
from kit.ros.node.time import Duration, Time
from kit.ros.serialization import Serializer

SERIALIZATION: Final = "cdr"


def get_default_storage_id() -> str:
    """The kind of storage of a bag of which none is named."""
    return "mcap"


def get_registered_writers() -> set[str]:
    """The kinds of storage that can be written."""
    return set(STORAGE_SETTINGS)


def get_registered_readers() -> set[str]:
    """The kinds of storage that can be read."""
    return set(STORAGE_SETTINGS)


@dataclass
class StorageOptions:
    """Where a bag lies, and its kind of storage. What would split, cache or compress it must keep its default."""

    uri: str
    storage_id: str = ""
    max_bagfile_size: int = 0
    max_bagfile_duration: int = 0
    max_cache_size: int = 0
    storage_preset_profile: str = ""
    storage_config_uri: str = ""
    snapshot_mode: bool = False
    start_time_ns: int = -1
    end_time_ns: int = -1
    custom_data: dict[str, str] = field(default_factory=dict)


@dataclass
class ConverterOptions:
    """How messages are serialized in the program and in the bag: ``cdr``, or nothing for the same."""

    input_serialization_format: str = ""
    output_serialization_format: str = ""


_SAME_FORMAT: Final = ConverterOptions()


class TopicMetadata:
    """A topic of a bag. ``id`` is left out in Humble's form: ``TopicMetadata(name, type, serialization_format)``."""

    def __init__(
        self,
        id: int | str = 0,  # noqa: A002 - ROS's name
        name: str = "",
        type: str = "",  # noqa: A002 - ROS's name
        serialization_format: str = SERIALIZATION,
        offered_qos_profiles: Sequence[QoSProfile] | str = (),
        type_description_hash: str = "",
    ) -> None:
        number = 0 if isinstance(id, str) else id
        if isinstance(id, str):
            name, type, serialization_format = id, name, type or SERIALIZATION  # noqa: A001 - ROS's name
        self.id = number
        self.name = name
        self.type = type
        self.serialization_format = serialization_format
        self.offered_qos_profiles = offered_qos_profiles
        self.type_description_hash = type_description_hash

    def __repr__(self) -> str:
        return f"TopicMetadata(id={self.id}, name={self.name!r}, type={self.type!r})"


@dataclass
class TopicInformation:
    """A topic and the number of its messages."""

    topic_metadata: TopicMetadata
    message_count: int


@dataclass
class BagMetadata:
    """What a bag says of itself."""

    version: int = 9
    bag_size: int = 0
    """[bytes]"""
    storage_identifier: str = ""
    relative_file_paths: list[str] = field(default_factory=list)
    duration: Duration = field(default_factory=Duration)
    starting_time: Time = field(default_factory=Time)
    message_count: int = 0
    topics_with_message_count: list[TopicInformation] = field(default_factory=list)
    compression_format: str = ""
    compression_mode: str = ""
    ros_distro: str = ""
    custom_data: dict[str, str] = field(default_factory=dict)


@dataclass
class StorageFilter:
    """Which topics to read: by name or by a regular expression; nothing means all."""

    topics: Sequence[str] = ()
    topics_regex: str = ""
    topics_regex_to_exclude: str = ""
    exclude_topics: Sequence[str] = ()

    def admits(self, topic: str) -> bool:
        if topic in self.exclude_topics or (
            self.topics_regex_to_exclude and re.fullmatch(self.topics_regex_to_exclude, topic)
        ):
            return False
        chooses = self.topics or self.topics_regex
        return (
            not chooses
            or topic in self.topics
            or bool(self.topics_regex and re.fullmatch(self.topics_regex, topic))
        )


class ReadOrderSortBy(IntEnum):
    """What messages are ordered by."""

    ReceivedTimestamp = 0
    PublishedTimestamp = 1
    File = 2


class SequentialWriter:
    """Writes a bag. Raises RuntimeError for what cannot be done."""

    def __init__(self) -> None:
        self._part: BagPart | None = None
        self._connections: dict[str, Connection] = {}

    def open(
        self, storage_options: StorageOptions, converter_options: ConverterOptions = _SAME_FORMAT
    ) -> None:
        """Begins a bag, which may not be there yet."""
        if self._part is not None:
            raise RuntimeError("Bag is already opened for writing")
        folder = Path(storage_options.uri).absolute()
        storage = storage_options.storage_id or get_default_storage_id()
        if storage not in STORAGE_SETTINGS:
            raise RuntimeError(
                f"No storage could be initialized for '{storage}'; there are {', '.join(STORAGE_SETTINGS)}"
            )
        _check_formats(converter_options)
        wanted = StorageOptions("").max_bagfile_size, StorageOptions("").max_bagfile_duration
        if (storage_options.max_bagfile_size, storage_options.max_bagfile_duration) != wanted:
            raise RuntimeError(
                "max_bagfile_size, max_bagfile_duration: bags of several files are not written here"
            )
        if storage_options.snapshot_mode:
            raise RuntimeError("snapshot_mode: snapshots are not written here")
        if folder.exists():
            raise RuntimeError(
                f"Bag directory already exists ({storage_options.uri}), can't overwrite existing bag"
            )
        try:
            tuple(restore_bags(folder.parent, wanted=folder))
            self._part = part = BagPart(folder, cast("Storage", storage))
        except OSError as problem:
            raise RuntimeError(str(problem)) from None
        self._serializer = Serializer(STORAGE_SETTINGS[cast("Storage", storage)].distro)
        self._finish = finalize(self, _complete, part)

    def create_topic(self, topic_with_type: TopicMetadata) -> None:
        """Begins a topic; a second time it does nothing."""
        part = self._opened()
        if topic_with_type.name in self._connections:
            return
        if topic_with_type.serialization_format not in ("", SERIALIZATION):
            raise RuntimeError(
                f"messages are written in {SERIALIZATION} alone, not {topic_with_type.serialization_format}"
            )
        try:
            cls = find_message(topic_with_type.type)
            profiles = topic_with_type.offered_qos_profiles
            self._connections[topic_with_type.name] = part.add_topic(
                topic_with_type.name,
                topic_with_type.type,
                self._serializer.definition(cls),
                self._serializer.type_hash(cls),
                [offered_profile(each) for each in profiles if isinstance(each, QoSProfile)],
            )
        except UnknownInterface as problem:
            raise RuntimeError(f"topic '{topic_with_type.name}': {problem}") from None
        except WRITE_ERRORS as problem:
            raise RuntimeError(
                f"topic '{topic_with_type.name}' cannot be written: {reason(problem)}"
            ) from None

    def remove_topic(self, topic_with_type: TopicMetadata) -> None:
        """Ends a topic: nothing more can be written to it."""
        self._connections.pop(topic_with_type.name, None)

    def write(self, topic_name: str, message: bytes, time_stamp: int, sequence_number: int = 0) -> None:
        """Writes a message, in CDR, and its time [ns]."""
        part = self._opened()
        if topic_name not in self._connections:
            raise RuntimeError(
                f"Failed to write on topic '{topic_name}'. Call create_topic() before first write."
            )
        try:
            part.write(self._connections[topic_name], time_stamp, bytes(message))
        except WRITE_ERRORS as problem:
            self._finish.detach()
            self._part = None
            part.rescue()
            raise RuntimeError(f"the bag ends early: {reason(problem)}") from None

    def take_snapshot(self) -> bool:
        """Returns False: there is no snapshot mode."""
        return False

    def close(self) -> None:
        """Completes the bag; a second time it does nothing."""
        if self._part is not None:
            self._part = None
            self._finish()

    def _opened(self) -> BagPart:
        if self._part is None:
            raise RuntimeError("Bag is not open. Call open() before writing.")
        return self._part


def _complete(part: BagPart) -> None:
    try:
        part.complete()
    except WRITE_ERRORS:
        part.rescue()


def _check_formats(options: ConverterOptions) -> None:
    for name in (options.input_serialization_format, options.output_serialization_format):
        if name not in ("", SERIALIZATION):
            raise RuntimeError(f"messages are serialized in {SERIALIZATION} alone here, not in '{name}'")


class SequentialReader:
    """Reads a bag, message by message in order of time. Raises RuntimeError for what cannot be done."""

    def __init__(self) -> None:
        self._stack = ExitStack()
        self._reader: Reader | None = None
        self._filter = StorageFilter()
        self._from_ns: int | None = None
        self._messages: Iterator[tuple[str, bytes, int]] | None = None
        self._next: tuple[str, bytes, int] | None = None

    def open(
        self, storage_options: StorageOptions, converter_options: ConverterOptions = _SAME_FORMAT
    ) -> None:
        """Opens a bag. ``storage_id`` need not be given; one that is must be the bag's."""
        _check_formats(converter_options)
        folder = _bag_folder(storage_options.uri)
        try:
            self._bag = read_bag(folder)
            self._reader = self._stack.enter_context(open_reader(folder))
        except BagError as problem:
            raise RuntimeError(str(problem)) from None
        if storage_options.storage_id not in ("", self._bag.storage):
            self.close()
            raise RuntimeError(
                f"{folder} is of the kind {self._bag.storage}, not {storage_options.storage_id}"
            )
        finalize(self, self._stack.close)

    def open_uri(self, uri: str) -> None:
        """Opens a bag of any kind."""
        self.open(StorageOptions(uri))

    def close(self) -> None:
        self._reader = None
        self._stack.close()

    def has_next(self) -> bool:
        """Whether ``read_next`` has a message."""
        if self._messages is None:
            self._messages = self._iterate()
            self._next = next(self._messages, None)
        return self._next is not None

    def read_next(self) -> tuple[str, bytes, int]:
        """The next message: its topic, itself in CDR, and its time [ns]."""
        if not self.has_next() or self._next is None or self._messages is None:
            raise RuntimeError("Bag is at end. No next message.")
        found = self._next
        self._next = next(self._messages, None)
        return found

    def get_all_topics_and_types(self) -> list[TopicMetadata]:
        self._opened()
        return [_topic_metadata(number, each) for number, each in enumerate(self._bag.topics, 1)]

    def get_metadata(self) -> BagMetadata:
        self._opened()
        return _metadata(self._bag)

    def set_filter(self, storage_filter: StorageFilter) -> None:
        """Reads on with the messages of certain topics only."""
        self._filter = storage_filter
        self._go_on()

    def reset_filter(self) -> None:
        """Reads on with the messages of all topics."""
        self.set_filter(StorageFilter())

    def seek(self, timestamp: int) -> None:
        """Goes to the first message at a time [ns] or later."""
        self._from_ns, self._messages, self._next = timestamp, None, None

    def _go_on(self) -> None:
        if self._messages is not None and self._next is not None:
            self._from_ns = self._next[2]
        self._messages = self._next = None

    def _iterate(self) -> Iterator[tuple[str, bytes, int]]:
        reader = self._opened()
        chosen = [each for each in reader.connections if self._filter.admits(each.topic)]
        if chosen:  # none would mean all
            for connection, time_ns, data in reader.messages(chosen, start=self._from_ns):
                yield connection.topic, bytes(data), time_ns

    def _opened(self) -> Reader:
        if self._reader is None:
            raise RuntimeError("Bag is not open. Call open() before reading.")
        return self._reader


class Info:
    """Reads what a bag says of itself."""

    def read_metadata(self, uri: str, storage_id: str = "") -> BagMetadata:
        """Raises RuntimeError."""
        try:
            return _metadata(read_bag(_bag_folder(uri)))
        except BagError as problem:
            raise RuntimeError(str(problem)) from None


def _bag_folder(uri: str) -> Path:
    """The folder of a bag, also of one of its files; what a killed recording has left there is completed first."""
    folder = Path(uri).absolute()
    if folder.suffix in (".mcap", ".db3") and folder.is_file():
        folder = folder.parent
    if not folder.exists() and folder.parent.is_dir():
        tuple(restore_bags(folder.parent))
    return folder


def _topic_metadata(number: int, topic: BagTopic) -> TopicMetadata:
    return TopicMetadata(number, topic.name, topic.type, topic.serialization, [topic.qos])


def _metadata(bag: Bag) -> BagMetadata:
    return BagMetadata(
        bag_size=bag.size,
        storage_identifier=bag.storage,
        relative_file_paths=list(bag.files),
        duration=Duration(nanoseconds=bag.duration_ns),
        starting_time=Time(nanoseconds=bag.start_ns),
        message_count=bag.count,
        topics_with_message_count=[
            TopicInformation(_topic_metadata(number, each), each.count)
            for number, each in enumerate(bag.topics, 1)
        ],
        ros_distro=bag.distro,
    )
