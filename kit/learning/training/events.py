"""Defines, writes and reads the events of a training run, one line each, in an append-only file.

A reader may look at any time, also while a line is half written; a writer may be killed at any time.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any, Literal, Self, TypeAlias

from kit.field_types import check_field_types
from kit.learning.environment.episode_stats import EpisodeOutcome
from kit.line_log import LineLog, LineReader
from kit.plain_text import escape_controls


@dataclass(frozen=True, slots=True)
class TrainingStarted:
    """The learner starts, or goes on after it was interrupted."""

    time: float
    """s since 1970."""
    steps: int
    """0, or what the checkpoint had that it goes on from."""
    versions: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class TrainingProgress:
    """Training since the last progress event."""

    steps: int
    """All in all."""
    seconds: float
    """Seconds of training in total; without pauses, with tests."""
    rate: float
    """Steps a second since the last one, tests left out."""
    episodes: dict[str, list[int]]
    """Number of episodes that ended in each ``Outcome``, in its order, by case."""
    reward: float | None
    """Mean sum over an episode; None where none has ended, as below."""
    length: float | None
    """Mean steps of an episode."""
    terms: dict[str, float]
    """Mean sum over an episode by named term of the reward."""
    adjacency: float | None = None
    """Mean share of steps side by side."""
    measures: dict[str, float] = field(default_factory=dict)
    """What the learner measures of its own learning, by the names of ``kit.learning.training.measures``."""

    def __post_init__(self) -> None:
        _check_counts(self.episodes)


@dataclass(frozen=True, slots=True)
class Evaluated:
    """A test of the strategy, on fresh episodes."""

    steps: int
    seconds: float
    cases: dict[str, list[int]]
    """Number of episodes that ended in each ``Outcome``, in its order, by case."""
    kept: bool
    """The best policy so far."""
    reward: float | None = None
    """Mean sum over an episode."""
    reason: str = ""
    """Why training stopped or went back, if it did."""
    adjacency: float | None = None
    """Mean share of an episode's steps that two robots were side by side; None for one robot."""

    def __post_init__(self) -> None:
        _check_counts(self.cases)
        if not self.cases:
            raise ValueError("a test of no case")

    measures: dict[str, float] = field(default_factory=dict)
    """As in ``TrainingProgress``."""


@dataclass(frozen=True, slots=True)
class TrainingNote:
    """Something a reader of the run should know."""

    text: str
    until_progress: bool = False
    """Whether it is over once the learner makes steps."""


@dataclass(frozen=True, slots=True)
class TrainingEnded:
    """The learner has ended of its own accord."""

    how: Literal["finished", "stopped", "failed"]
    steps: int
    seconds: float
    reason: str


TrainingEvent: TypeAlias = TrainingStarted | TrainingProgress | Evaluated | TrainingNote | TrainingEnded

EVENT_TYPES: Mapping[str, type[TrainingEvent]] = MappingProxyType(
    {
        "started": TrainingStarted,
        "progress": TrainingProgress,
        "examined": Evaluated,
        "noted": TrainingNote,
        "ended": TrainingEnded,
    }
)
_EVENT_NAMES = {kind: name for name, kind in EVENT_TYPES.items()}


def _check_counts(by_case: Mapping[str, Sequence[int]]) -> None:
    """ValueError for anything but the number of episodes that ended in each outcome."""
    for case, counts in by_case.items():
        if len(counts) != len(EpisodeOutcome) or min(counts) < 0:
            raise ValueError(f"{case}: {counts} are not the episodes that ended in each outcome")


def encode_event(event: TrainingEvent) -> bytes:
    """A line of JSON, without its end."""
    return json.dumps({"event": _EVENT_NAMES[type(event)], **asdict(event)}).encode()


def decode_event(line: bytes) -> TrainingEvent | None:
    """The event; None if it is damaged. Its texts are as a terminal may show them, and its numbers finite: the run may be
    somebody else's."""
    try:
        data = _shown_safely(json.loads(line))
        kind = EVENT_TYPES[data.pop("event")]
        check_field_types(kind, data)
        if any(data.get(name, 0) < 0 for name in ("steps", "seconds")):
            return None
        return kind(**data)
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return None


def _shown_safely(value: Any) -> Any:
    """The same without control characters. ValueError for a number that is not finite."""
    match value:
        case str():
            return escape_controls(value)
        case list():
            return [_shown_safely(each) for each in value]
        case dict():
            return {escape_controls(name): _shown_safely(each) for name, each in value.items()}
        case float() if not math.isfinite(value):
            raise ValueError(f"{value} is no measure")
    return value


class EventWriter:
    """Appends events to a file."""

    def __init__(self, file: Path) -> None:
        self._file = file.open("a+b")
        try:
            self._log = LineLog(self._file)
        except OSError:
            self._file.close()
            raise

    def write(self, event: TrainingEvent) -> None:
        """OSError if the disk is full; nothing of the event stands in the file then."""
        self._log.append(encode_event(event))

    def close(self) -> None:
        self._file.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


class EventReader:
    """Reads a run's events as they come, each once; of a file without end its newest."""

    def __init__(self, file: Path, *, from_now: bool = False) -> None:
        """``from_now``: leave out what stands in the file already. Raises OSError."""
        self._lines = LineReader(file, from_now=from_now)

    def read_new(self) -> Iterator[TrainingEvent]:
        """Returns the events written since the last call; none while there is no file. Raises OSError."""
        for line in self._lines.read_new():
            event = decode_event(line)
            if event is not None:
                yield event
