"""Bags: what was said on topics, and when, in files that ROS 2's tools open (rosbag2), by way of rosbags.

Times are those of the graph: in a simulation, simulation time. Not imported by the rest of ``kit.ros``.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import chain, count
from pathlib import Path
from types import MappingProxyType, TracebackType
from typing import Any, Final, Literal, Self

from rosbags.interfaces import (
    Connection,
    ConnectionExtRosbag2,
    Qos,
    QosDurability,
    QosHistory,
    QosLiveliness,
    QosReliability,
    QosTime,
)
from rosbags.rosbag2 import Reader, ReaderError, StoragePlugin, Writer, WriterError

from kit.msg.interfaces import UnknownInterface, find_message
from kit.msg.message import Message
from kit.ros.execution.callback_groups import MutuallyExclusiveCallbackGroup
from kit.ros.graph.graph import Graph
from kit.ros.graph.naming import topic_or_service_is_hidden
from kit.ros.node.endpoint import SubscriptionEventCallbacks
from kit.ros.node.node import Node, create_graph_node
from kit.ros.node.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from kit.ros.node.subscription import Subscription
from kit.ros.node.time import Duration
from kit.ros.serialization import Distro, Serializer

Storage = Literal["mcap", "sqlite3"]

RECORDER: Final = "rosbag2_recorder"
FOR_EVER: Final = QosTime(9223372036, 854775807)
"""How ROS 2 writes a time that never comes."""


@dataclass(frozen=True, slots=True)
class _Kind:
    """What goes with a kind of storage: the oldest ROS 2 that reads it by itself is what it is written for."""

    plugin: StoragePlugin
    version: Literal[8, 9]
    distro: Distro


_KINDS: Final = MappingProxyType(
    {
        "mcap": _Kind(StoragePlugin.MCAP, 9, "jazzy"),
        "sqlite3": _Kind(StoragePlugin.SQLITE3, 8, "humble"),
    }
)


class BagError(OSError):
    """A bag that cannot be read or written; the message says which and why."""


class _Tap(Subscription[Any]):
    """Hands on each message at the moment at which it is said."""

    def __init__(
        self, node: Node, cls: type[Message], topic: str, qos: QoSProfile, hear: Callable[[Any], None]
    ) -> None:
        self._hear = hear
        group = MutuallyExclusiveCallbackGroup()
        quiet = SubscriptionEventCallbacks(use_default_callbacks=False)
        super().__init__(node.handle, cls, topic, hear, group, qos, quiet)
        node.handle.subscriptions.append(self)

    def enqueue(self, msg: Any) -> None:
        self._hear(msg)


class BagRecorder:
    """Writes what is said in a graph into a new bag, until it is closed. A guest of whoever ticks.

    ``topics`` None: all but hidden ones, also those that come later. The bag appears under its name when it is
    complete; until then, and after a kill, what there is of it lies in ``.NAME.part`` beside it.
    Raises BagError.
    """

    def __init__(
        self,
        graph: Graph,
        folder: Path,
        *,
        topics: Collection[str] | None = None,
        storage: Storage = "mcap",
        node: Node | None = None,
    ) -> None:
        self._graph = graph
        self._folder = folder.absolute()
        self._wanted = None if topics is None else frozenset(topics)
        self._kind = _KINDS[storage]
        self._serializer = Serializer(self._kind.distro)
        self._connections: dict[str, Connection] = {}
        self._version = -1
        self._node = node
        self.failure: str | None = None
        """Why nothing more is written; None while all is well."""
        self.count = 0
        """Messages so far."""
        if self._folder.exists():
            raise BagError(f"{folder} is there already. Name another folder, or remove it.")
        self._part = _free(self._folder.parent, f".{self._folder.name}.part")
        self._writer = Writer(
            self._part / self._folder.name, version=self._kind.version, storage_plugin=self._kind.plugin
        )
        try:
            self._writer.open()
        except (OSError, WriterError) as problem:
            raise BagError(f"{folder}: no bag can be written there ({_reason(problem)}).") from None
        if self._node is None:
            self._node = create_graph_node(graph, RECORDER)
        self.exchange()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, problem: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @property
    def topics(self) -> tuple[str, ...]:
        """Those it listens to."""
        return tuple(self._connections)

    @property
    def missing(self) -> tuple[str, ...]:
        """Topics it was to listen to and that nobody publishes yet."""
        return tuple(sorted((self._wanted or frozenset()) - self._connections.keys()))

    def exchange(self) -> bool:
        """Listens to topics that are new since the last time. Never has anything to say."""
        directory = self._graph.directory
        if directory.version != self._version:
            for name, types in directory.topic_names_and_types():
                chosen = (
                    not topic_or_service_is_hidden(name) if self._wanted is None else name in self._wanted
                )
                if chosen and name not in self._connections and len(types) == 1:
                    self._listen(name, types[0])
            self._version = directory.version
        return False

    def close(self) -> None:
        """Completes the bag. May be called twice. Raises BagError when its end cannot be written."""
        node, self._node = self._node, None
        if node is None:
            return
        node.destroy_node()
        try:
            self._writer.close()
            self._writer.path.rename(self._folder)
            self._part.rmdir()
        except OSError as problem:
            raise BagError(
                f"{self._folder}: the bag could not be completed ({_reason(problem)}). "
                f"What there is of it lies in {self._part}."
            ) from None
        if self.failure is not None:
            raise BagError(self.failure)

    def _listen(self, topic: str, type_of: str) -> None:
        assert self._node is not None
        cls = find_message(type_of)
        publishers = list(self._graph.directory.publishers(topic))
        self._connections[topic] = connection = self._writer.add_connection(
            topic,
            type_of,
            msgdef=self._serializer.definition(cls),
            rihs01=self._serializer.type_hash(cls),
            offered_qos_profiles=[_offered(publisher.qos_profile) for publisher in publishers],
        )
        _Tap(
            self._node,
            cls,
            topic,
            self._graph.directory.matching_qos(topic),
            lambda msg: self._keep(connection, msg),
        )

    def _keep(self, connection: Connection, message: Message) -> None:
        if self.failure is None:
            try:
                self._writer.write(connection, self._graph.now_ns, self._serializer.serialize(message))
            except OSError as problem:  # not the publisher's fault, in whose call this happens
                self.failure = f"{self._folder}: the bag ends early: {_reason(problem)}."
            else:
                self.count += 1


def _free(folder: Path, name: str) -> Path:
    """A path that nothing is at: what a killed recording left is not touched."""
    numbered = (f"{name}{number}" for number in count(2))
    return next(folder / each for each in chain([name], numbered) if not (folder / each).exists())


def _offered(profile: QoSProfile) -> Qos:
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
        return FOR_EVER
    return QosTime(*divmod(duration.nanoseconds, 1_000_000_000))


@dataclass(frozen=True, slots=True)
class BagTopic:
    name: str
    type: str
    count: int
    serialization: str
    qos: QoSProfile
    """To publish it with: what was offered first."""


@dataclass(frozen=True, slots=True)
class Bag:
    """What a bag's own summary says of it."""

    folder: Path
    files: tuple[str, ...]
    size: int
    """Bytes of the files."""
    storage: str
    distro: str
    start_ns: int
    duration_ns: int
    count: int
    topics: tuple[BagTopic, ...]
    """By name."""


def read_bag(folder: Path) -> Bag:
    """The summary of a bag: a folder with ``metadata.yaml``. Raises BagError."""
    with _opened(folder) as reader:
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
    """``(time_ns, topic, message)`` in order of time. Raises BagError.

    Topics of a type that the kit does not have are left out; ``skipped`` is told their name and type.
    """
    serializers = [Serializer("humble"), Serializer("jazzy")]
    with _opened(folder) as reader:
        found: dict[int, tuple[Serializer, type[Message]]] = {}
        for connection in reader.connections:
            if topics is None or connection.topic in topics:
                way = _way_to_read(connection, serializers)
                if way is not None:
                    found[connection.id] = way
                elif skipped is not None:
                    skipped(connection.topic, connection.msgtype)
        chosen = [connection for connection in reader.connections if connection.id in found]
        if not chosen:  # none would mean all
            return
        try:
            for connection, time_ns, data in reader.messages(chosen):
                serializer, cls = found[connection.id]
                yield time_ns, connection.topic, serializer.deserialize(bytes(data), cls)
        except (ReaderError, ValueError) as problem:
            raise BagError(f"{folder}: a damaged bag: {problem}") from None


def _way_to_read(
    connection: Connection, serializers: Sequence[Serializer]
) -> tuple[Serializer, type[Message]] | None:
    """Whose types the messages of a topic are; None if the kit does not have them."""
    try:
        cls = find_message(connection.msgtype)
    except UnknownInterface:
        return None
    if not connection.digest:  # bags tell it from Iron on
        return serializers[0], cls
    return next(((each, cls) for each in serializers if each.type_hash(cls) == connection.digest), None)


@contextmanager
def _opened(folder: Path) -> Iterator[Reader]:
    if not (folder / "metadata.yaml").is_file():
        raise BagError(f"{folder}: not a bag: a bag is a folder with a metadata.yaml in it.")
    try:
        reader = Reader(folder)
        reader.open()
    except (OSError, ReaderError) as problem:
        raise BagError(f"{folder}: not a bag, or a damaged one: {_reason(problem)}") from None
    try:
        yield reader
    finally:
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


def _reason(problem: Exception) -> str:
    return (problem.strerror if isinstance(problem, OSError) else None) or str(problem)
