"""Records and reads bags: the messages of topics with their times, in rosbag2 files. Uses the rosbags library.

Times are those of the graph: in a simulation, simulation time. Not imported by the rest of ``kit.ros``.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, Self

from rosbags.interfaces import (
    Connection,
    ConnectionExtRosbag2,
    MessageDefinitionFormat,
    Qos,
    QosDurability,
    QosHistory,
    QosLiveliness,
    QosReliability,
    QosTime,
)

from kit.interruption import uninterrupted
from kit.msg.class_builder import build_recorded_message
from kit.msg.interfaces import DefinitionError, UnknownInterface, find_message
from kit.msg.message import Message
from kit.part_file import BeingWrittenError
from kit.plain_text import quoted
from kit.ros.bag_reader import LimitedReader
from kit.ros.bag_storage import (
    STORAGE_SETTINGS,
    WRITE_ERRORS,
    BagError,
    BagPart,
    Storage,
    is_being_recorded,
    reason,
    restore_bags,
)
from kit.ros.execution.callback_groups import MutuallyExclusiveCallbackGroup
from kit.ros.graph.graph import Graph
from kit.ros.graph.naming import topic_or_service_is_hidden
from kit.ros.node.events import SubscriptionEventCallbacks
from kit.ros.node.node import Node, create_graph_node
from kit.ros.node.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from kit.ros.node.subscription import Subscription
from kit.ros.node.time import Duration
from kit.ros.serialization import Serializer

RECORDER: Final = "rosbag2_recorder"
MAX_PENDING: Final = 64
MAX_PENDING_BYTES: Final = 1 << 20
"""Messages, and their bytes, that are written at once: to keep signals away takes longer than to write a message."""
FLUSH_INTERVAL_S: Final = 1.0
"""After this long all messages are on the disk [s]."""
INFINITE_TIME: Final = QosTime(9223372036, 854775807)
"""How ROS 2 writes an infinite duration."""


class _RecordingSubscription(Subscription[Any]):
    """A subscription that calls back at once, with the time at which the message was published."""

    def __init__(
        self, node: Node, cls: type[Message], topic: str, qos: QoSProfile, on_message: Callable[[Any], None]
    ) -> None:
        self._on_message = on_message
        group = MutuallyExclusiveCallbackGroup()
        quiet = SubscriptionEventCallbacks(use_default_callbacks=False)
        super().__init__(node.handle, cls, topic, on_message, group, qos, quiet)
        node.handle.subscriptions.append(self)

    def enqueue(self, msg: Any) -> None:
        self._on_message(msg)


class BagRecorder:
    """Records the messages of a graph in a new bag until it is closed. A participant of the lock-step.

    ``topics`` None: all but hidden ones, also those that come later. The bag appears under its name when it is
    complete; until then what there is of it lies in ``.NAME.part`` beside it, every second. What a killed recording has
    left there, or of another bag in that folder, is restored first; ``notices`` says so. Raises BagError, also if another
    program records a bag of this name.
    """

    def __init__(
        self,
        graph: Graph,
        folder: Path,
        *,
        topics: Collection[str] | None = None,
        storage: Storage = "mcap",
        node: Node | None = None,
        hidden: bool = False,
        admits: Callable[[str], bool] = lambda topic: True,
    ) -> None:
        """``hidden``: without ``topics``, also hidden ones, such as those of actions. ``admits``: of these the ones for whose
        name this is true."""
        self._admits = admits
        self._graph = graph
        self._folder = folder.absolute()
        self._requested_topics = None if topics is None else frozenset(topics)
        self._hidden = hidden
        self._serializer = Serializer(STORAGE_SETTINGS[storage].distro)
        self._connections: dict[str, Connection] = {}
        self._version = -1
        self._node = node
        self._pending: list[tuple[Connection, int, bytes]] = []
        self._pending_bytes = 0
        self.failure: str | None = None
        """Why writing has stopped; None while it works."""
        self.count = 0
        """Number of messages recorded."""
        if self._folder.exists():
            raise BagError(f"{folder} already exists. Choose another folder, or remove it.")
        try:
            self.notices = tuple(restore_bags(self._folder.parent, wanted=self._folder))
            """A sentence for each bag that was restored."""
            self._part = BagPart(self._folder, storage)
        except BeingWrittenError as problem:
            raise BagError(str(problem)) from None
        self._flushed_s = time.monotonic()
        if self._node is None:
            self._node = create_graph_node(graph, RECORDER)
        self.exchange()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def topics(self) -> tuple[str, ...]:
        """The topics it records."""
        return tuple(self._connections)

    @property
    def missing(self) -> tuple[str, ...]:
        """Requested topics that no node publishes yet."""
        return tuple(sorted((self._requested_topics or frozenset()) - self._connections.keys()))

    def exchange(self) -> bool:
        """Subscribes to new topics. Returns False, since it sends nothing."""
        directory = self._graph.directory
        if directory.version != self._version:
            for name, types in directory.topic_names_and_types():
                chosen = (
                    self._hidden or not topic_or_service_is_hidden(name)
                    if self._requested_topics is None
                    else name in self._requested_topics
                )
                if chosen and self._admits(name) and name not in self._connections and len(types) == 1:
                    self._subscribe(name, types[0])
            self._version = directory.version
        if time.monotonic() - self._flushed_s >= FLUSH_INTERVAL_S:
            with uninterrupted():  # half a record would make what follows unreadable
                self._write_pending()
        return False

    def close(self) -> None:
        """Completes the bag. May be called twice. Raises BagError if writing fails."""
        node = self._node
        if node is None:
            return
        with uninterrupted():
            self._node = None
            node.destroy_node()
            self._write_pending()
            try:
                if self.failure is None:
                    self._part.complete()
            except WRITE_ERRORS as problem:
                self._fail(problem)
            if self.failure is not None:
                self.count = self._part.rescue()
        if self.failure is not None:
            raise BagError(self.failure)

    def _subscribe(self, topic: str, type_of: str) -> None:
        assert self._node is not None
        cls = find_message(type_of)
        profiles = [
            offered_profile(publisher.qos_profile) for publisher in self._graph.directory.publishers(topic)
        ]
        with uninterrupted():
            try:
                connection = self._part.add_topic(
                    topic,
                    type_of,
                    self._serializer.definition(cls),
                    self._serializer.type_hash(cls),
                    profiles,
                )
            except WRITE_ERRORS as problem:
                self._fail(problem)
                return
            self._connections[topic] = connection
        _RecordingSubscription(
            self._node,
            cls,
            topic,
            self._graph.directory.matching_qos(topic),
            lambda msg: self._write(connection, msg),
        )

    def _write(self, connection: Connection, message: Message) -> None:
        if self.failure is not None:
            return
        data = self._serializer.serialize(message)
        self._pending.append((connection, self._graph.now_ns, data))
        self._pending_bytes += len(data)
        self.count += 1
        if len(self._pending) >= MAX_PENDING or self._pending_bytes >= MAX_PENDING_BYTES:
            with uninterrupted():  # half a record would make what follows unreadable
                self._write_pending()

    def _write_pending(self) -> None:
        """Puts all messages on the disk."""
        pending, self._pending, self._pending_bytes = self._pending, [], 0
        if self.failure is not None:
            return
        written = 0
        try:
            for connection, time_ns, data in pending:
                self._part.write(connection, time_ns, data)
                written += 1
        except WRITE_ERRORS as problem:  # not the publisher's fault, in whose call this happens
            self.count -= len(pending) - written
            self._fail(problem)
            return
        if time.monotonic() - self._flushed_s >= FLUSH_INTERVAL_S:
            self._flushed_s = time.monotonic()
            try:
                self._part.flush()
            except WRITE_ERRORS as problem:
                self._fail(problem)

    def _fail(self, problem: Exception) -> None:
        if self.failure is None:
            self.failure = f"{self._folder}: the bag ends early: {reason(problem)}."


def offered_profile(profile: QoSProfile) -> Qos:
    return Qos(
        QosHistory(int(profile.history)),
        profile.depth,
        QosReliability(int(profile.reliability)),
        QosDurability(int(profile.durability)),
        _time(profile.deadline),
        _time(profile.lifespan),
        QosLiveliness(int(profile.liveliness)),
        _time(profile.liveliness_lease_duration),
        profile.avoid_ros_namespace_conventions,
    )


def _time(duration: Duration) -> QosTime:
    if duration.nanoseconds == 0:
        return INFINITE_TIME
    return QosTime(*divmod(duration.nanoseconds, 1_000_000_000))


@dataclass(frozen=True, slots=True)
class BagTopic:
    name: str
    type: str
    count: int
    serialization: str
    qos: QoSProfile
    """The profile to publish it with: the first one offered."""


@dataclass(frozen=True, slots=True)
class Bag:
    """The summary of a bag."""

    folder: Path
    files: tuple[str, ...]
    size: int
    """Size of the files [bytes]."""
    storage: str
    distro: str
    start_ns: int
    duration_ns: int
    count: int
    topics: tuple[BagTopic, ...]
    """Sorted by name."""


def read_bag(folder: Path) -> Bag:
    """Reads the summary of a bag, a folder with ``metadata.yaml``. Raises BagError."""
    with open_reader(folder) as reader:
        files = tuple(sorted(path.name for path in folder.iterdir() if path.suffix in (".mcap", ".db3")))
        return Bag(
            folder,
            files,
            sum((folder / name).stat().st_size for name in files),
            "mcap" if any(name.endswith(".mcap") for name in files) else "sqlite3",
            reader.ros_distro or "unknown",
            reader.start_time if reader.message_count else 0,
            max(0, reader.duration - 1),
            reader.message_count,
            tuple(
                _topic(connection) for connection in sorted(reader.connections, key=lambda each: each.topic)
            ),
        )


def read_messages(
    folder: Path, topics: Collection[str] | None = None, *, skipped: Callable[[str, str], None] | None = None
) -> Iterator[tuple[int, str, Message]]:
    """Yields ``(time_ns, topic, message)`` in order of time. Raises BagError.

    A type that the kit does not have is built from the definition in the bag. Topics without one are left out;
    ``skipped`` is told their name and type.
    """
    serializers = [Serializer("humble"), Serializer("jazzy")]
    with open_reader(folder) as reader:
        found: dict[int, tuple[Serializer, type[Message]]] = {}
        for connection in reader.connections:
            if topics is None or connection.topic in topics:
                way = _serializer_for(connection, serializers)
                if way is not None:
                    found[connection.id] = way
                elif skipped is not None:
                    skipped(connection.topic, connection.msgtype)
        chosen = [connection for connection in reader.connections if connection.id in found]
        if not chosen:  # none would mean all
            return
        for connection, time_ns, data in reader.messages(chosen):
            serializer, cls = found[connection.id]
            yield time_ns, connection.topic, serializer.deserialize(bytes(data), cls)


def _serializer_for(
    connection: Connection, serializers: Sequence[Serializer]
) -> tuple[Serializer, type[Message]] | None:
    """The serializer and class for the messages of a topic; None if neither the kit nor the bag has the type."""
    try:
        cls = find_message(connection.msgtype)
    except UnknownInterface:
        definition = connection.msgdef
        if definition.format is not MessageDefinitionFormat.MSG or connection.msgtype.count("/") != 2:
            return None
        try:
            cls = build_recorded_message(connection.msgtype, definition.data, find_message)
        except (DefinitionError, LookupError):
            return None
    if not connection.digest:  # bags tell it from Iron on
        return serializers[0], cls
    return next(((each, cls) for each in serializers if each.type_hash(cls) == connection.digest), None)


@contextmanager
def open_reader(folder: Path) -> Iterator[LimitedReader]:
    if not (folder / "metadata.yaml").is_file():
        if is_being_recorded(folder):
            raise BagError(f"{folder}: a program records this bag now. It can be read when that has ended.")
        raise BagError(f"{folder}: not a bag: a bag is a folder with a metadata.yaml in it.")
    for each in folder.iterdir():  # a named pipe would hold the reader
        if not each.is_file():
            raise BagError(f"{folder}: {quoted(each.name)} in it is not a file.")
    try:
        reader = LimitedReader(folder)
        reader.open()
    except Exception as problem:  # noqa: BLE001 - whatever a damaged file makes the library raise
        raise BagError(f"{folder}: not a bag, or a damaged one: {reason(problem)}") from None
    try:
        yield reader
    except BagError:
        raise
    except Exception as problem:  # noqa: BLE001 - likewise; what a caller does with a message is not in here
        raise BagError(f"{folder}: a damaged bag: {reason(problem)}") from None
    finally:
        with suppress(Exception):  # it was damaged, and that is told
            reader.close()


def _topic(connection: Connection) -> BagTopic:
    assert isinstance(connection.ext, ConnectionExtRosbag2)
    offered = connection.ext.offered_qos_profiles
    qos = QoSProfile(depth=10)
    if offered:
        qos = QoSProfile(
            depth=max(1, offered[0].depth),
            reliability=ReliabilityPolicy(int(offered[0].reliability.value)),
            durability=DurabilityPolicy(int(offered[0].durability.value)),
        )
    return BagTopic(
        connection.topic, connection.msgtype, connection.msgcount, connection.ext.serialization_format, qos
    )
