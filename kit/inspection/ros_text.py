"""Formats nodes, topics, messages, bags and measured rates as ROS 2's commands print them."""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from math import sqrt
from types import MappingProxyType
from typing import Any, Final

from kit.msg.definition_parser import parse_definition
from kit.msg.fields import MessageKind, item_kind
from kit.msg.interfaces import PACKAGES, Interface, definition, definition_source, find_message
from kit.msg.message import Message, Service, type_name
from kit.msg.rcl_interfaces import FloatingPointRange, IntegerRange, ParameterDescriptor, ParameterValue
from kit.plain_text import counted, format_size
from kit.ros.bags import Bag
from kit.ros.graph.action_names import NamesAndTypes, called_actions, served_actions
from kit.ros.graph.directory import NodeEntry
from kit.ros.graph.graph import Graph
from kit.ros.graph.naming import topic_or_service_is_hidden
from kit.ros.node.endpoint import TopicEndpointInfo, TopicEndpointTypeEnum
from kit.ros.node.qos import HistoryPolicy, LivelinessPolicy
from kit.ros.node.time import Duration
from kit.ros.parameters.parameter import PARAMETER_SEPARATOR_STRING, Parameter, parameter_value_to_python
from kit.ros.serialization import Serializer


def node_names(graph: Graph, *, hidden: bool) -> list[str]:
    """Full names, sorted; a hidden node's own name begins with an underscore."""
    handles = graph.directory.nodes
    return sorted(handle.full_name for handle in handles if hidden or not handle.name.startswith("_"))


def absolute_name(name: str) -> str:
    """The name of a node or topic with a leading slash."""
    return name if name.startswith("/") else f"/{name}"


def topics(graph: Graph, *, hidden: bool) -> NamesAndTypes:
    found = graph.directory.topic_names_and_types()
    return [entry for entry in found if hidden or not topic_or_service_is_hidden(entry[0])]


def services(graph: Graph, *, hidden: bool) -> NamesAndTypes:
    found = graph.directory.service_names_and_types()
    return [entry for entry in found if hidden or not topic_or_service_is_hidden(entry[0])]


def node_info(handle: NodeEntry, *, hidden: bool) -> Iterator[str]:
    """The lines of ``node info``: an empty section holds an empty line, as in ROS 2."""
    yield handle.full_name
    sections: tuple[tuple[str, Iterable[tuple[str, str]]], ...] = (
        ("Subscribers", ((end.topic_name, type_name(end.msg_type)) for end in handle.subscriptions)),
        ("Publishers", ((end.topic_name, type_name(end.msg_type)) for end in handle.publishers)),
        ("Service Servers", ((end.service_name, type_name(end.srv_type)) for end in handle.services)),
        ("Service Clients", ((end.service_name, type_name(end.srv_type)) for end in handle.clients)),
        ("Action Servers", _flat(served_actions(handle))),
        ("Action Clients", _flat(called_actions(handle))),
    )
    for title, ends in sections:
        yield f"  {title}:"
        types: dict[str, set[str]] = {}
        for name, type_of in ends:
            if hidden or not topic_or_service_is_hidden(name):
                types.setdefault(name, set()).add(type_of)
        yield "\n".join(f"    {name}: {', '.join(sorted(types[name]))}" for name in sorted(types))


def _flat(names_and_types: NamesAndTypes) -> Iterator[tuple[str, str]]:
    return ((name, each) for name, types in names_and_types for each in types)


def topic_summary(graph: Graph, names_and_types: NamesAndTypes) -> Iterator[str]:
    """The lines of ``topic list -v``."""
    for title, word, count_of in (
        ("Published", "publisher", graph.directory.publishers),
        ("Subscribed", "subscriber", graph.directory.subscriptions),
    ):
        yield f"{title} topics:"
        for name, types in names_and_types:
            count = sum(1 for _ in count_of(name))
            if count:
                yield f" * {name} [{', '.join(types)}] {counted(count, word)}"
        yield ""


def topic_info(graph: Graph, name: str, types: list[str], *, verbose: bool) -> Iterator[str]:
    """The lines of ``topic info``."""
    yield f"Type: {types[0] if len(types) == 1 else types}"
    for title, kind, ends in (
        ("Publisher", TopicEndpointTypeEnum.PUBLISHER, list(graph.directory.publishers(name))),
        ("Subscription", TopicEndpointTypeEnum.SUBSCRIPTION, list(graph.directory.subscriptions(name))),
    ):
        if verbose:
            yield ""
        yield f"{title} count: {len(ends)}"
        if verbose:
            for end in ends:
                yield ""
                yield from _endpoint(TopicEndpointInfo.of(end, kind))
    if verbose:
        yield ""


def _endpoint(info: TopicEndpointInfo) -> Iterator[str]:
    qos = info.qos_profile
    history = qos.history.name + (f" ({qos.depth})" if qos.history == HistoryPolicy.KEEP_LAST else "")
    liveliness = qos.liveliness
    if liveliness == LivelinessPolicy.SYSTEM_DEFAULT:
        liveliness = LivelinessPolicy.AUTOMATIC
    yield f"Node name: {info.node_name}"
    yield f"Node namespace: {info.node_namespace}"
    yield f"Topic type: {info.topic_type}"
    yield f"Topic type hash: {Serializer().type_hash(find_message(info.topic_type))}"
    yield f"Endpoint type: {info.endpoint_type.name}"
    yield f"GID: {'.'.join(f'{part:02x}' for part in info.endpoint_gid)}"
    yield "QoS profile:"
    yield f"  Reliability: {qos.reliability.name}"
    yield f"  History (Depth): {history}"
    yield f"  Durability: {qos.durability.name}"
    yield f"  Lifespan: {_time(qos.lifespan)}"
    yield f"  Deadline: {_time(qos.deadline)}"
    yield f"  Liveliness: {liveliness.name}"
    yield f"  Liveliness lease duration: {_time(qos.liveliness_lease_duration)}"


def _time(duration: Duration) -> str:
    return "Infinite" if duration.nanoseconds == 0 else f"{duration.nanoseconds} nanoseconds"


def service_info(graph: Graph, name: str, types: list[str]) -> Iterator[str]:
    """The lines of ``service info``."""
    yield f"Type: {types[0] if len(types) == 1 else types}"
    yield f"Clients count: {len(graph.directory.clients.get(name, ()))}"
    yield f"Services count: {len(graph.directory.services.get(name, ()))}"


# The kit's own note to itself in the texts that it ships.
_SINCE: Final = re.compile(r"\s*# added in \w+\s*$")


@dataclass(frozen=True, slots=True)
class CommentOptions:
    """Which comments are shown."""

    own: bool = True
    """Those of the interface's own file."""
    nested: bool = False
    """Those of the messages in it."""


def definition_text(cls: Interface, comments: CommentOptions = CommentOptions()) -> str:
    """The text of an interface, with those of all messages in it, each level indented by a tab.

    Raises DefinitionError.
    """
    return "".join(f"{line}\n" for line in _lines(cls, comments.own, comments.nested, 0))


def _lines(cls: Interface, comments: bool, nested_comments: bool, depth: int) -> Iterator[str]:
    text, kind, messages = _source(cls)
    sections = parse_definition(text, kind, cls.__ros_type__)
    fields = {
        member.line: field.kind
        for message, section in zip(messages, sections, strict=True)
        for member, field in zip(section.fields, message.__ros_fields__, strict=True)
    }
    for number, line in enumerate(text.splitlines(), start=1):
        shown = _SINCE.sub("", line).rstrip() if comments else line.partition("#")[0].rstrip()
        if not shown and not comments:
            continue
        package = cls.__ros_type__.partition("/")[0]
        if (
            number in fields and package in PACKAGES
        ):  # ROS 2's own files name a neighbour by its own name alone
            shown = shown.removeprefix(f"{package}/")
        yield "\t" * depth + shown if shown else ""
        item = item_kind(fields[number]) if number in fields else None
        if isinstance(item, MessageKind):
            yield from _lines(item.cls, nested_comments, nested_comments, depth + 1)


def _source(cls: Interface) -> tuple[str, str, tuple[type[Message], ...]]:
    """The text of an interface, the kind of file that it is, and the messages of its sections."""
    kind, messages = "msg", _sections(cls)
    if not issubclass(cls, Message):
        kind = "srv" if issubclass(cls, Service) else "action"
    try:
        return definition_source(cls.__ros_type__), kind, messages
    except (LookupError, FileNotFoundError):  # a part of an action, which has no file of its own
        return definition(cls), kind, messages


def _sections(cls: Interface) -> tuple[type[Message], ...]:
    if issubclass(cls, Message):
        return (cls,)
    return (cls.Request, cls.Response) if issubclass(cls, Service) else (cls.Goal, cls.Result, cls.Feedback)


_NAMES: Final = MappingProxyType(
    {
        Parameter.Type.NOT_SET: ("not set", "Parameter not set."),
        Parameter.Type.BOOL: ("boolean", "Boolean value is:"),
        Parameter.Type.INTEGER: ("integer", "Integer value is:"),
        Parameter.Type.DOUBLE: ("double", "Double value is:"),
        Parameter.Type.STRING: ("string", "String value is:"),
        Parameter.Type.BYTE_ARRAY: ("byte array", "Byte values are:"),
        Parameter.Type.BOOL_ARRAY: ("boolean array", "Boolean values are:"),
        Parameter.Type.INTEGER_ARRAY: ("integer array", "Integer values are:"),
        Parameter.Type.DOUBLE_ARRAY: ("double array", "Double values are:"),
        Parameter.Type.STRING_ARRAY: ("string array", "String values are:"),
    }
)
"""The name of each type, and the label before its value."""


def type_name_of(number: int) -> str:
    """The name of a type."""
    return _NAMES[Parameter.Type(number)][0]


def format_value(value: ParameterValue, *, hide_type: bool = False) -> str:
    """A parameter's value, as ``param get`` prints it."""
    found = parameter_value_to_python(value)
    if hide_type:
        return str(found)
    words = _NAMES[Parameter.Type(value.type)][1]
    return words if found is None else f"{words} {found}"


def description(descriptor: ParameterDescriptor) -> Iterator[str]:
    """The lines of ``param describe``."""
    yield f"Parameter name: {descriptor.name}"
    yield f"  Type: {type_name_of(descriptor.type)}"
    if descriptor.description:
        yield f"  Description: {descriptor.description}"
    yield "  Constraints:"
    if descriptor.read_only:
        yield "    Read only: true"
    ranges: list[FloatingPointRange | IntegerRange] = [
        *descriptor.floating_point_range,
        *descriptor.integer_range,
    ]
    for allowed in ranges[:1]:
        yield f"    Min value: {allowed.from_value}"
        yield f"    Max value: {allowed.to_value}"
        if allowed.step:
            yield f"    Step: {allowed.step}"
    if descriptor.additional_constraints:
        yield f"    Additional constraints: {descriptor.additional_constraints}"


def nest_by_name(values: Iterable[tuple[str, Any]]) -> dict[str, Any]:
    """Nests values by the parts of their names: ``a.b`` becomes ``{a: {b: ...}}``."""
    tree: dict[str, Any] = {}
    for name, value in values:
        *groups, last = name.split(PARAMETER_SEPARATOR_STRING)
        branch = tree
        for group in groups:
            branch = branch.setdefault(group, {})
        branch[last] = value
    return tree


class NoSuchField(LookupError):
    """The message has no such field; the error names it."""


def get_field(message: Message, path: str) -> Any:
    """The value at a path of field names joined by dots. Raises NoSuchField."""
    found: Any = message
    for name in path.split("."):
        if not isinstance(found, Message) or name not in type(found).get_fields_and_field_types():
            has = (
                ", ".join(type(found).get_fields_and_field_types()) if isinstance(found, Message) else "none"
            )
            raise NoSuchField(f"Invalid field '{path}': there is no '{name}'; available fields: {has}")
        found = getattr(found, name)
    return found


RATE_WINDOW: Final = 10_000
BANDWIDTH_WINDOW: Final = 100
"""The default numbers of messages that rates and delays, and bandwidth, are taken over."""


@dataclass(frozen=True, slots=True)
class DurationStatistics:
    """Mean, extremes and standard deviation of durations [s]."""

    mean: float
    low: float
    high: float
    deviation: float
    count: int

    @classmethod
    def of(cls, durations_ns: Sequence[int]) -> DurationStatistics:
        count = len(durations_ns)
        mean = sum(durations_ns) / count
        variance = sum((duration - mean) ** 2 for duration in durations_ns) / count
        return cls(mean / 1e9, min(durations_ns) / 1e9, max(durations_ns) / 1e9, sqrt(variance) / 1e9, count)

    def __str__(self) -> str:
        return (
            f"min: {self.low:.3f}s max: {self.high:.3f}s std dev: {self.deviation:.5f}s window: {self.count}"
        )


class RateMeter:
    """Measures how often messages arrive, by the intervals between them."""

    def __init__(self, window: int = RATE_WINDOW) -> None:
        self._intervals: deque[int] = deque(maxlen=window)
        self._last_ns: int | None = None

    def add(self, now_ns: int) -> None:
        """Counts a message. Restarts if time has jumped back."""
        if self._last_ns is not None and now_ns < self._last_ns:
            self._intervals.clear()
        elif self._last_ns is not None:
            self._intervals.append(now_ns - self._last_ns)
        self._last_ns = now_ns

    def text(self) -> str | None:
        """The report; None before the second message."""
        if not self._intervals:
            return None
        statistics = DurationStatistics.of(self._intervals)
        rate = 1 / statistics.mean if statistics.mean > 0 else 0.0
        return f"average rate: {rate:.3f}\n\t{statistics}"


class DelayMeter:
    """Measures how old messages are on arrival, by the time in their header."""

    def __init__(self, window: int = RATE_WINDOW) -> None:
        self._delays: deque[int] = deque(maxlen=window)
        self._is_new = False

    def add(self, now_ns: int, stamp_ns: int) -> None:
        self._delays.append(now_ns - stamp_ns)
        self._is_new = True

    def text(self) -> str | None:
        """The report; None before the first message."""
        if not self._delays:
            return None
        if not self._is_new:
            return "no new messages"
        self._is_new = False
        statistics = DurationStatistics.of(self._delays)
        return f"average delay: {statistics.mean:.3f}\n\t{statistics}"


class BandwidthMeter:
    """Measures the bytes per second that arrive."""

    def __init__(self, window: int = BANDWIDTH_WINDOW) -> None:
        self._messages: deque[tuple[int, int]] = deque(maxlen=window)

    def add(self, now_ns: int, size: int) -> None:
        self._messages.append((now_ns, size))

    def text(self, now_ns: int) -> str | None:
        """The report; None before the second message, or if no time has passed."""
        if len(self._messages) < 2 or now_ns <= self._messages[0][0]:
            return None
        sizes = [size for _, size in self._messages]
        rate = sum(sizes) / ((now_ns - self._messages[0][0]) / 1e9)
        shown = [_bytes(size, rate) for size in (rate, sum(sizes) / len(sizes), min(sizes), max(sizes))]
        return (
            f"{shown[0]}/s from {len(sizes)} messages\n"
            f"\tMessage size mean: {shown[1]} min: {shown[2]} max: {shown[3]}"
        )


def _bytes(size: float, rate: float) -> str:
    """A number of bytes, in a unit that suits the rate."""
    if rate < 1000:
        return f"{size:.0f} B"
    return f"{size / 1000:.2f} KB" if rate < 1_000_000 else f"{size / 1_000_000:.2f} MB"


LABEL_WIDTH = 19


def bag_info(bag: Bag) -> str:
    """The output of ``bag info``, which begins with an empty line."""
    end_ns = bag.start_ns + bag.duration_ns
    topics = [
        f"Topic: {topic.name} | Type: {topic.type} | Count: {topic.count} | "
        f"Serialization Format: {topic.serialization}"
        for topic in bag.topics
    ]
    rows: tuple[tuple[str, list[str]], ...] = (
        ("Files", list(bag.files)),
        ("Bag size", [format_size(bag.size)]),
        ("Storage id", [bag.storage]),
        ("ROS Distro", [bag.distro]),
        ("Duration", [f"{_seconds(bag.duration_ns)}s"]),
        ("Start", [_instant(bag.start_ns)]),
        ("End", [_instant(end_ns)]),
        ("Messages", [str(bag.count)]),
        ("Topic information", topics),
    )
    lines = [""]
    for label, values in rows:
        first, *rest = values or [""]
        lines.append(f"{f'{label}:':<{LABEL_WIDTH}}{first}")
        lines += [" " * LABEL_WIDTH + value for value in rest]
    return "\n".join(lines)


def _seconds(time_ns: int) -> str:
    return f"{time_ns // 1_000_000_000}.{time_ns % 1_000_000_000:09d}"


def _instant(time_ns: int) -> str:
    """A time in UTC, since simulated time begins with 1970."""
    moment = datetime.fromtimestamp(time_ns // 1_000_000_000, UTC)
    return f"{moment:%b} {moment.day:2d} {moment:%Y %H:%M:%S}.{time_ns % 1_000_000_000:09d} ({_seconds(time_ns)})"
