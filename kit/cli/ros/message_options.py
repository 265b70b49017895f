"""Messages and quality of service on a command line: a type and its fields in YAML, and the options of the topics' verbs."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import wraps
from typing import Any, TypeVar

import click
import yaml

from kit.cli.ros.world_client import exit_with_error, register_workspace_interfaces
from kit.msg.builtin_interfaces import Time
from kit.msg.conversion import ConversionError, from_dict
from kit.msg.fields import MessageKind
from kit.msg.interfaces import DefinitionError, UnknownInterface
from kit.msg.message import Message
from kit.msg.std_msgs import Header
from kit.ros.node.qos import DurabilityPolicy, HistoryPolicy, QoSPresetProfiles, QoSProfile, ReliabilityPolicy
from kit.yaml_numbers import UnambiguousLoader

T = TypeVar("T")


class _Loader(UnambiguousLoader):
    """A YAML loader that also reads ``1e-3`` as a number."""


_Loader.add_implicit_resolver(
    "tag:yaml.org,2002:float", re.compile(r"[-+]?[0-9]+(\.[0-9]*)?[eE][-+]?[0-9]+$"), list("-+0123456789")
)


def find_or_exit(find: Callable[[str], T], name: str) -> T:
    """The message or service class that ``find(name)`` returns; exits if there is none."""
    register_workspace_interfaces()
    try:
        return find(name)
    except (UnknownInterface, DefinitionError) as problem:
        exit_with_error(f"The passed type is invalid: {problem}")


def parse_fields(text: str) -> Mapping[str, Any]:
    """The fields in a YAML text; exits if it cannot be read."""
    try:
        content = yaml.load(text, Loader=_Loader)
    except yaml.YAMLError as problem:
        exit_with_error(f"The passed value is not YAML: {' '.join(str(problem).split())}")
    if content in (None, ""):
        return {}
    if not isinstance(content, dict):
        exit_with_error(
            "The passed value needs to be a dictionary in YAML format, such as '{linear: {x: 0.5}}'"
        )
    return content


def make_message(cls: type[Message], content: Mapping[str, Any], now_ns: int) -> Any:
    """A message with these fields; exits if they do not fit. ``auto`` for a header and ``now`` for a time: ``now_ns``."""
    try:
        return from_dict(cls, _with_timestamps(cls, content, now_ns))
    except ConversionError as problem:
        exit_with_error(f"Failed to populate field: {problem}")


def _with_timestamps(cls: type[Message], content: Mapping[str, Any], now_ns: int) -> dict[str, Any]:
    now = {"sec": now_ns // 1_000_000_000, "nanosec": now_ns % 1_000_000_000}
    kinds = {field.name: field.kind for field in cls.__ros_fields__}
    dated = dict(content)
    for name, value in content.items():
        kind = kinds.get(name)
        if not isinstance(kind, MessageKind):
            continue
        if kind.cls is Header and value == "auto":
            dated[name] = {"stamp": now}
        elif kind.cls is Time and value == "now":
            dated[name] = now
        elif isinstance(value, Mapping):
            dated[name] = _with_timestamps(kind.cls, value, now_ns)
    return dated


@dataclass(frozen=True, slots=True)
class QosOptions:
    """The values of the options; None where one was not given."""

    preset: str | None
    history: str | None
    depth: int | None
    reliability: str | None
    durability: str | None

    def profile(self, default: QoSProfile) -> QoSProfile:
        """The profile: the preset, or ``default`` without one, changed by the other options."""
        base = default if self.preset is None else QoSPresetProfiles.get_from_short_key(self.preset)
        profile = QoSProfile(
            history=base.history, depth=base.depth, reliability=base.reliability, durability=base.durability
        )
        if self.depth is not None:
            profile.history, profile.depth = HistoryPolicy.KEEP_LAST, self.depth
        if self.history is not None:
            profile.history = HistoryPolicy.get_from_short_key(self.history)
        if self.reliability is not None:
            profile.reliability = ReliabilityPolicy.get_from_short_key(self.reliability)
        if self.durability is not None:
            profile.durability = DurabilityPolicy.get_from_short_key(self.durability)
        return profile


def with_qos_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """Decorator: adds the options, and passes their values as ``qos_options``."""

    @click.option(
        "--qos-profile",
        type=click.Choice(QoSPresetProfiles.short_keys()),
        metavar="PROFILE",
        help=f"QoS preset to start from: {', '.join(QoSPresetProfiles.short_keys())}.",
    )
    @click.option("--qos-history", type=click.Choice(HistoryPolicy.short_keys()))
    @click.option("--qos-depth", type=click.IntRange(0))
    @click.option("--qos-reliability", type=click.Choice(ReliabilityPolicy.short_keys()))
    @click.option("--qos-durability", type=click.Choice(DurabilityPolicy.short_keys()))
    @wraps(function)
    def verb(
        *arguments: Any,
        qos_profile: str | None,
        qos_history: str | None,
        qos_depth: int | None,
        qos_reliability: str | None,
        qos_durability: str | None,
        **rest: Any,
    ) -> None:
        qos_options = QosOptions(qos_profile, qos_history, qos_depth, qos_reliability, qos_durability)
        function(*arguments, qos_options=qos_options, **rest)

    return verb
