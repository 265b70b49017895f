"""Quality of service: policies, profiles, presets, and whether two profiles are compatible."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from enum import Enum, IntEnum
from typing import Any, ClassVar, Self

from kit.ros.node.time import Duration


class InvalidQoSProfileException(Exception):
    """The settings of a profile contradict each other."""

    def __init__(self, *args: object) -> None:
        super().__init__("Invalid QoSProfile", *args)


class QoSPolicyKind(IntEnum):
    """The policies, as flags."""

    INVALID = 1 << 0
    DURABILITY = 1 << 1
    DEADLINE = 1 << 2
    LIVELINESS = 1 << 3
    RELIABILITY = 1 << 4
    HISTORY = 1 << 5
    LIFESPAN = 1 << 6
    DEPTH = 1 << 7
    LIVELINESS_LEASE_DURATION = 1 << 8
    AVOID_ROS_NAMESPACE_CONVENTIONS = 1 << 9


class QoSPolicyEnum(IntEnum):
    """A policy whose values also have short names, for the command line."""

    @classmethod
    def short_keys(cls) -> list[str]:
        return [member.name.lower() for member in cls if member.name not in ("RMW_UNKNOWN", "UNKNOWN")]

    @classmethod
    def get_from_short_key(cls, name: str) -> Self:
        return cls[name.upper()]

    @property
    def short_key(self) -> str:
        return self.name.lower()


class HistoryPolicy(QoSPolicyEnum):
    SYSTEM_DEFAULT = 0
    KEEP_LAST = 1
    KEEP_ALL = 2
    UNKNOWN = 3


class ReliabilityPolicy(QoSPolicyEnum):
    SYSTEM_DEFAULT = 0
    RELIABLE = 1
    BEST_EFFORT = 2
    UNKNOWN = 3
    BEST_AVAILABLE = 4


class DurabilityPolicy(QoSPolicyEnum):
    SYSTEM_DEFAULT = 0
    TRANSIENT_LOCAL = 1
    VOLATILE = 2
    UNKNOWN = 3
    BEST_AVAILABLE = 4


class LivelinessPolicy(QoSPolicyEnum):
    SYSTEM_DEFAULT = 0
    AUTOMATIC = 1
    MANUAL_BY_TOPIC = 3
    UNKNOWN = 4
    BEST_AVAILABLE = 5


QoSHistoryPolicy = HistoryPolicy
QoSReliabilityPolicy = ReliabilityPolicy
QoSDurabilityPolicy = DurabilityPolicy
QoSLivelinessPolicy = LivelinessPolicy


class QoSProfile:
    """A complete set of policies. ``QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)``.

    Needs a ``history`` or a ``depth``; KEEP_LAST needs a depth. Of a publisher that keeps messages for
    later subscriptions, ``lifespan`` limits how old they may be; a simulation is late with no other message.
    """

    __slots__ = (
        "avoid_ros_namespace_conventions",
        "deadline",
        "depth",
        "durability",
        "history",
        "lifespan",
        "liveliness",
        "liveliness_lease_duration",
        "reliability",
    )

    _TYPES: ClassVar[dict[str, type[Any]]] = {
        "history": HistoryPolicy,
        "depth": int,
        "reliability": ReliabilityPolicy,
        "durability": DurabilityPolicy,
        "lifespan": Duration,
        "deadline": Duration,
        "liveliness": LivelinessPolicy,
        "liveliness_lease_duration": Duration,
        "avoid_ros_namespace_conventions": bool,
    }

    WIRED: ClassVar[tuple[str, ...]] = tuple(name for name, kind in _TYPES.items() if kind is not bool)
    """The settings that another process is told."""

    history: HistoryPolicy
    depth: int
    reliability: ReliabilityPolicy
    durability: DurabilityPolicy
    lifespan: Duration
    deadline: Duration
    liveliness: LivelinessPolicy
    liveliness_lease_duration: Duration
    avoid_ros_namespace_conventions: bool

    def __init__(self, **kwargs: Any) -> None:
        unknown = kwargs.keys() - self._TYPES.keys()
        if unknown:
            known = ", ".join(self._TYPES)
            raise AssertionError(
                f"Invalid arguments passed to constructor: {sorted(unknown)}; available: {known}"
            )
        if "history" not in kwargs and "depth" not in kwargs:
            raise InvalidQoSProfileException("History and/or depth settings are required.")
        if kwargs.get("history") == HistoryPolicy.KEEP_LAST and "depth" not in kwargs:
            raise InvalidQoSProfileException("History set to KEEP_LAST without a depth setting.")
        settings: dict[str, Any] = {
            "history": HistoryPolicy.KEEP_LAST,
            "depth": 0,
            "reliability": ReliabilityPolicy.RELIABLE,
            "durability": DurabilityPolicy.VOLATILE,
            "lifespan": Duration(),
            "deadline": Duration(),
            "liveliness": LivelinessPolicy.SYSTEM_DEFAULT,
            "liveliness_lease_duration": Duration(),
            "avoid_ros_namespace_conventions": False,
        }
        for name, value in (settings | kwargs).items():
            setattr(self, name, value)

    def __setattr__(self, name: str, value: Any) -> None:
        wanted = self._TYPES[name]
        if issubclass(wanted, IntEnum) and isinstance(value, int):
            value = wanted(value)
        if not isinstance(value, wanted):
            raise TypeError(f"QoSProfile.{name} must be a {wanted.__name__}, not {type(value).__name__}")
        if name == "depth" and value < 0:
            raise ValueError("depth must be greater than or equal to zero")
        object.__setattr__(self, name, value)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, QoSProfile):
            return False
        return all(getattr(self, name) == getattr(other, name) for name in self._TYPES)

    def __hash__(self) -> int:
        return hash(tuple(getattr(self, name) for name in self._TYPES))

    def __repr__(self) -> str:
        return f"QoSProfile({', '.join(f'{name}={getattr(self, name)}' for name in self._TYPES)})"

    def copy(self) -> QoSProfile:
        """A profile with the same settings."""
        return QoSProfile(**{name: getattr(self, name) for name in self._TYPES})

    @property
    def numbers(self) -> list[int]:
        """The settings of ``WIRED``, durations in nanoseconds."""
        values = (getattr(self, name) for name in self.WIRED)
        return [value.nanoseconds if isinstance(value, Duration) else int(value) for value in values]

    @classmethod
    def from_numbers(cls, numbers: Iterable[int]) -> QoSProfile:
        """Raises ValueError."""
        return cls(
            **{
                name: Duration(nanoseconds=value) if cls._TYPES[name] is Duration else value
                for name, value in zip(cls.WIRED, numbers, strict=True)
            }
        )

    @property
    def is_best_effort(self) -> bool:
        return self.reliability == ReliabilityPolicy.BEST_EFFORT

    @property
    def is_transient_local(self) -> bool:
        return self.durability == DurabilityPolicy.TRANSIENT_LOCAL

    @property
    def queue_length(self) -> int | None:
        """The length of a queue; None for KEEP_ALL."""
        return None if self.history == HistoryPolicy.KEEP_ALL else max(1, self.depth)


def _profile(depth: int = 10, **settings: Any) -> QoSProfile:
    return QoSProfile(history=HistoryPolicy.KEEP_LAST, depth=depth, **settings)


qos_profile_default = _profile()
qos_profile_system_default = QoSProfile(
    history=HistoryPolicy.SYSTEM_DEFAULT,
    depth=0,
    reliability=ReliabilityPolicy.SYSTEM_DEFAULT,
    durability=DurabilityPolicy.SYSTEM_DEFAULT,
)
qos_profile_sensor_data = _profile(5, reliability=ReliabilityPolicy.BEST_EFFORT)
qos_profile_services_default = _profile()
qos_profile_parameters = _profile(1000)
qos_profile_parameter_events = _profile(1000)
qos_profile_rosout_default = _profile(
    1000, durability=DurabilityPolicy.TRANSIENT_LOCAL, lifespan=Duration(seconds=10)
)
qos_profile_action_status_default = _profile(1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
qos_profile_best_available = _profile(
    reliability=ReliabilityPolicy.BEST_AVAILABLE,
    durability=DurabilityPolicy.BEST_AVAILABLE,
    liveliness=LivelinessPolicy.BEST_AVAILABLE,
)
qos_profile_unknown = QoSProfile(
    history=HistoryPolicy.UNKNOWN,
    depth=0,
    reliability=ReliabilityPolicy.UNKNOWN,
    durability=DurabilityPolicy.UNKNOWN,
    liveliness=LivelinessPolicy.UNKNOWN,
)


class QoSPresetProfiles(Enum):
    """The presets by name: ``QoSPresetProfiles.SENSOR_DATA.value``."""

    UNKNOWN = qos_profile_unknown
    DEFAULT = qos_profile_default
    SYSTEM_DEFAULT = qos_profile_system_default
    SENSOR_DATA = qos_profile_sensor_data
    SERVICES_DEFAULT = qos_profile_services_default
    PARAMETERS = qos_profile_parameters
    PARAMETER_EVENTS = qos_profile_parameter_events
    ACTION_STATUS_DEFAULT = qos_profile_action_status_default
    BEST_AVAILABLE = qos_profile_best_available

    @classmethod
    def short_keys(cls) -> list[str]:
        return [name.lower() for name in cls.__members__ if name != "UNKNOWN"]

    @classmethod
    def get_from_short_key(cls, name: str) -> QoSProfile:
        return cls[name.upper()].value


def qos_or_depth(value: QoSProfile | int) -> QoSProfile:
    """The profile that a ``qos_profile`` argument means: a number is a KEEP_LAST depth."""
    if isinstance(value, int) and not isinstance(value, bool):
        return QoSProfile(depth=value)
    if not isinstance(value, QoSProfile):
        raise TypeError(f"Expected QoSProfile or int, but received {value!r}")
    return value


def first_incompatibility(offered: QoSProfile, requested: QoSProfile) -> QoSPolicyKind | None:
    """The policy on which a publisher offers less than a subscription asks for; None if they are compatible."""
    if offered.is_best_effort and requested.reliability == ReliabilityPolicy.RELIABLE:
        return QoSPolicyKind.RELIABILITY
    if requested.is_transient_local and offered.durability not in (
        DurabilityPolicy.TRANSIENT_LOCAL,
        DurabilityPolicy.BEST_AVAILABLE,
    ):
        return QoSPolicyKind.DURABILITY
    if _is_longer(offered.deadline, requested.deadline):
        return QoSPolicyKind.DEADLINE
    if (
        requested.liveliness == LivelinessPolicy.MANUAL_BY_TOPIC
        and offered.liveliness != LivelinessPolicy.MANUAL_BY_TOPIC
    ) or _is_longer(offered.liveliness_lease_duration, requested.liveliness_lease_duration):
        return QoSPolicyKind.LIVELINESS
    return None


def _is_longer(offered: Duration, requested: Duration) -> bool:
    """True if the offered duration is longer than the requested one; zero means no limit."""
    limit = requested.nanoseconds
    return limit != 0 and (offered.nanoseconds == 0 or offered.nanoseconds > limit)


class QoSCompatibility(IntEnum):
    OK = 0
    WARNING = 1
    ERROR = 2


def qos_check_compatible(
    publisher_qos: QoSProfile, subscription_qos: QoSProfile
) -> tuple[QoSCompatibility, str]:
    """Whether messages pass between a publisher and a subscription with these profiles, and every reason why not.

    The reasons are those of the middleware, each ended by a semicolon. Where none speaks against it, a policy that is left
    to the middleware is a warning; that is so for two profiles that say nothing of liveliness.
    """
    if errors := "".join(f"ERROR: {each};" for each in _contradictions(publisher_qos, subscription_qos)):
        return QoSCompatibility.ERROR, errors
    if warnings := "".join(f"WARNING: {each};" for each in _doubts(publisher_qos, subscription_qos)):
        return QoSCompatibility.WARNING, warnings
    return QoSCompatibility.OK, ""


def _contradictions(offered: QoSProfile, requested: QoSProfile) -> Iterator[str]:
    """Yields in what a publisher certainly offers less than a subscription asks for."""
    if offered.is_best_effort and requested.reliability == ReliabilityPolicy.RELIABLE:
        yield "Best effort publisher and reliable subscription"
    if offered.durability == DurabilityPolicy.VOLATILE and requested.is_transient_local:
        yield "Volatile publisher and transient local subscription"
    if _is_longer(offered.deadline, requested.deadline):
        if offered.deadline.nanoseconds == 0:
            yield "Subscription has a deadline, but publisher does not"
        else:
            yield "Subscription deadline is less than publisher deadline"
    if (offered.liveliness, requested.liveliness) == (
        LivelinessPolicy.AUTOMATIC,
        LivelinessPolicy.MANUAL_BY_TOPIC,
    ):
        yield "Publisher's liveliness is automatic and subscription's is manual by topic"
    if _is_longer(offered.liveliness_lease_duration, requested.liveliness_lease_duration):
        if offered.liveliness_lease_duration.nanoseconds == 0:
            yield "Subscription has a liveliness lease duration, but publisher does not"
        else:
            yield "Subscription liveliness lease duration is less than publisher"


def _doubts(offered: QoSProfile, requested: QoSProfile) -> Iterator[str]:
    """Yields the policies of which one or both sides leave the choice to the middleware, which may choose amiss."""
    for policy, least, if_least, most, if_most in (
        (
            "reliability",
            ReliabilityPolicy.BEST_EFFORT,
            "Best effort publisher, but subscription is",
            ReliabilityPolicy.RELIABLE,
            "Reliable subscription, but publisher is",
        ),
        (
            "durability",
            DurabilityPolicy.VOLATILE,
            "Volatile publisher, but subscription is",
            DurabilityPolicy.TRANSIENT_LOCAL,
            "Transient local subscription, but publisher is",
        ),
        (
            "liveliness",
            LivelinessPolicy.AUTOMATIC,
            "Publisher's liveliness is automatic, but subscription's is",
            LivelinessPolicy.MANUAL_BY_TOPIC,
            "Subscription's liveliness is manual by topic, but publisher's is",
        ),
    ):
        ours, theirs = getattr(offered, policy), getattr(requested, policy)
        open_ours, open_theirs = (each.name in ("SYSTEM_DEFAULT", "UNKNOWN") for each in (ours, theirs))
        if open_ours and open_theirs:
            yield f"Publisher {policy} is {ours.short_key} and subscription {policy} is {theirs.short_key}"
        elif open_ours and theirs == most:
            yield f"{if_most} {ours.short_key}"
        elif open_theirs and ours == least:
            yield f"{if_least} {theirs.short_key}"
