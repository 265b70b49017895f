"""Recordings: a run's inputs, enough to run it again to the bit, and all poses, to look at.

One ``.npz`` file: ``header`` (JSON as bytes) and the arrays of ``Recording``. No pickle.
"""

from __future__ import annotations

import hashlib
import io
import json
import math
import struct
from array import array
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Protocol, Self

import numpy as np
from numpy.typing import NDArray

from kit.array_archives import MAX_PACKED_BYTES, read_arrays
from kit.arrays import FloatArray, IntArray
from kit.interruption import uninterrupted
from kit.msg.conversion import from_dict, to_dict
from kit.msg.interfaces import find_interface
from kit.msg.message import Message
from kit.plain_text import quoted, suggestion
from kit.ros.graph.graph import Graph
from kit.run.episode import run_until
from kit.run.lockstep import Observer
from kit.run.runner import Runner
from kit.sim.simulation import SERVICES, Simulation, SimulationError
from kit.workspace import write_atomically
from kit.world.records import World

if TYPE_CHECKING:
    from kit.run.scenario import Scenario

FORMAT: Final = 1

MAX_TIME_S: Final = 2**31 - 1
"""What a stamp of ROS can say [s]."""

MAX_HEADER_BYTES: Final = 32 << 20
"""Bytes of a recording's inputs and names: reading them takes ten times as much memory."""

MAX_RECORDED_BYTES: Final = MAX_PACKED_BYTES - (1 << 20)
"""Bytes that a run records at most, so that its file can be read, also where nothing of it can be packed: five hours of one
robot at 100 ticks a second."""

ACCEPT: Final = "accept"
"""The kind of input that is a message on a topic."""


class RecordingError(Exception):
    """The file is no recording, or a damaged one; the message says which and what is wrong."""


@dataclass(frozen=True, slots=True)
class Input:
    """A message or a service call that reached the world just before tick number ``tick``."""

    tick: int
    kind: str
    """``accept``, or one of ``kit.sim.simulation.SERVICES``."""
    content: tuple[Any, ...]
    """JSON-able."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Recording:
    """The inputs of one run and the poses of all models. ``load_recording`` reads it from a file.

    >>> summary = kit.run_episode("maze", "forward", seconds=1.0, seed=1, record="run.npz")
    >>> recording = kit.load_recording("run.npz")
    >>> recording.track("serp").shape  # x [m], y [m], theta [rad] at every tick
    (100, 3)
    """

    place: str
    """A map's name, or a world file."""
    case: str | None
    """The map's case."""
    seed: int
    step_size: float
    models: tuple[tuple[int, tuple[str, ...]], ...]
    """Which models there were, each time with the first tick of which this is true."""
    inputs: tuple[Input, ...]
    poses: FloatArray
    """(sum of counts, 3) ``x y theta``: of every model's first body, tick after tick."""
    counts: IntArray
    """(ticks,): models at each tick."""
    level: str | None = None
    """The level of the game that was driven, whose world differs from the map's; recordings of old kits name none."""

    @property
    def ticks(self) -> int:
        return len(self.counts)

    def __repr__(self) -> str:
        """``Recording(maze: 100 ticks of 0.01 s, serp)``"""
        return f"Recording({self.place}: {self.ticks:,} ticks of {self.step_size:g} s, {', '.join(self._model_names())})"

    def moves(self, least: float = 0.01) -> bool:
        """Whether any model comes ``least`` metres or radians away from where it once was."""
        tracks = (self.track(name) for name in self._model_names())
        return any(len(track) and float(np.ptp(track, axis=0).max()) >= least for track in tracks)

    def first(self, ticks: int) -> Recording:
        """Its first ticks alone.

        >>> summary = kit.run_episode("maze", "forward", seconds=1.0, seed=1, record="run.npz")
        >>> kit.load_recording("run.npz").first(30)
        Recording(maze: 30 ticks of 0.01 s, serp)
        """
        counts = self.counts[:ticks]
        return replace(
            self,
            models=tuple(each for each in self.models if each[0] < ticks),
            inputs=tuple(each for each in self.inputs if each.tick < ticks),
            poses=self.poses[: int(counts.sum())],
            counts=counts,
        )

    def _model_names(self) -> tuple[str, ...]:
        """The names of all models that there ever were."""
        return tuple(dict.fromkeys(name for _, names in self.models for name in names))

    def track(self, model: str) -> FloatArray:
        """(k, 3): the poses of a model at all ticks at which it existed. LookupError for one that there never was."""
        known = self._model_names()
        if known and model not in known:
            raise LookupError(
                f"there is no model {quoted(model)} in this recording: {suggestion(model, known)}"
            )
        starts = np.concatenate([[0], np.cumsum(self.counts)])
        rows = []
        ends = (*(tick for tick, _ in self.models), self.ticks)[1:]  # none at all before the first tick
        for (first, names), after in zip(self.models, ends, strict=True):
            if model in names:
                rows.append(starts[first:after] + names.index(model))
        return self.poses[np.concatenate(rows).astype(np.int64)] if rows else np.empty((0, 3))


@dataclass(frozen=True, slots=True)
class RecordingSize:
    """How much a recording holds of each of its parts."""

    ticks: int
    poses: int
    inputs: int
    models: int

    def plus(self, other: Recording) -> RecordingSize:
        """The size with what has come after."""
        return RecordingSize(
            self.ticks + other.ticks,
            self.poses + len(other.poses),
            self.inputs + len(other.inputs),
            self.models + len(other.models),
        )


NOTHING: Final = RecordingSize(0, 0, 0, 0)


class RecordingStore(Protocol):
    """Where a run is written while it is recorded; see ``kit.run.recording_file``."""

    def begin(self, first: Recording) -> None:
        """Starts anew, with a recording that has no ticks yet."""

    def offer(self, recorder: Recorder) -> None:
        """Records a tick where one is due; called after every tick."""


class Recorder(Observer):
    """Records a run as one of its observers, from its first tick on; into ``store`` too, as the run goes on.

    A run that takes more than a recording may hold goes on, and its first ticks are recorded.
    """

    def __init__(
        self,
        place: str,
        case: str | None,
        simulation: Simulation,
        level: str | None = None,
        store: RecordingStore | None = None,
    ) -> None:
        self._place = place
        self._case = case
        self._level = level
        self._seed = simulation.seed
        self._step_size = simulation.step_size
        self._simulation = simulation
        self._inputs: list[bytes] = []  # JSON, a fifth of the memory that its values take
        self._header_bytes = self._recorded_bytes = 0
        self._is_full = False
        self._poses = array("d")
        self._counts = array("q")
        self._models: list[tuple[int, tuple[str, ...]]] = []
        self._store = store
        if store is not None:
            store.begin(self.recording())

    @classmethod
    def for_scenario(
        cls, scenario: Scenario, simulation: Simulation, store: RecordingStore | None = None
    ) -> Self:
        """Records a run of ``scenario``."""
        case = None if scenario.case is None else scenario.case.name
        return cls(scenario.name, case, simulation, scenario.level, store)

    @property
    def ticks(self) -> int:
        """How many have been recorded."""
        return len(self._counts)

    @property
    def is_full(self) -> bool:
        """Whether the recording holds as much as it may, and the ticks that follow are left out."""
        return self._is_full

    def on_message(self, topic: str, message: Message) -> None:
        self._add_input(ACCEPT, topic, type(message).__ros_type__, to_dict(message))

    def on_service(self, service: str, *arguments: Any) -> None:
        self._add_input(service, *arguments)

    def on_step(self, simulation: Simulation) -> None:
        if self._is_full:
            if self._store is not None:
                self._store.offer(self)
            return
        names = simulation.model_names
        if not self._models or self._models[-1][1] != names:
            self._models.append((len(self._counts), names))
            self._count_header(sum(map(len, names)))
        for pose in simulation.poses():
            self._poses.extend(pose)
        self._counts.append(len(names))
        self._recorded_bytes += 8 * (3 * len(names) + 1)
        if self._recorded_bytes >= MAX_RECORDED_BYTES:
            self._is_full = True
        if self._store is not None:
            self._store.offer(self)

    def recording(self, since: RecordingSize = NOTHING) -> Recording:
        """The run so far, or what has come after ``since``: all ticks that have ended, also where a signal has interrupted
        the one after."""
        counts = np.array(self._counts[since.ticks :], dtype=np.int64)
        poses = np.array(self._poses[3 * since.poses :], dtype=np.float64)[: 3 * counts.sum()]
        return Recording(
            self._place,
            self._case,
            self._seed,
            self._step_size,
            tuple(self._models[since.models :]),
            tuple(map(_read_input, json.loads(b"[%b]" % b",".join(self._inputs[since.inputs :])))),
            poses.reshape(-1, 3),
            counts,
            self._level,
        )

    def _add_input(self, kind: str, *content: Any) -> None:
        if not self._is_full:
            self._inputs.append(json.dumps((len(self._counts), kind, content)).encode())
            self._count_header(len(self._inputs[-1]))

    def _count_header(self, size: int) -> None:
        """Counts bytes of the header: a megabyte is left for what is not counted."""
        self._header_bytes += size + 2
        self._recorded_bytes += size + 2
        self._is_full |= self._header_bytes >= MAX_HEADER_BYTES - (1 << 20)


def _read_input(entry: Sequence[Any]) -> Input:
    tick, kind, content = entry
    return Input(int(tick), str(kind), tuple(content))


def save_recording(recording: Recording, file: Path) -> None:
    """Writes the file whole or not at all. Raises OSError."""
    data = io.BytesIO()
    np.savez_compressed(
        data,
        header=np.frombuffer(json.dumps(recording_header(recording)).encode(), dtype=np.uint8),
        poses=recording.poses,
        counts=recording.counts,
    )
    with uninterrupted():
        write_atomically(file, data.getvalue())


def recording_header(recording: Recording) -> dict[str, Any]:
    """All but the arrays; JSON-able."""
    return {
        "format": FORMAT,
        "place": recording.place,
        "case": recording.case,
        "seed": recording.seed,
        "step_size": recording.step_size,
        "models": recording.models,
        "inputs": [(each.tick, each.kind, each.content) for each in recording.inputs],
        "level": recording.level,
    }


def load_recording(file: Path | str) -> Recording:
    """Reads a recording that ``kit run --record``, a race or ``run_episode`` wrote.

    Raises RecordingError if the file is damaged or something else, and OSError if it cannot be read.

    >>> summary = kit.run_episode("maze", "forward", seconds=1.0, record="run.npz")
    >>> kit.load_recording("run.npz").ticks
    100
    """
    file = Path(file)
    try:
        arrays = read_arrays(file)
        if len(arrays["header"]) > MAX_HEADER_BYTES:
            raise ValueError(f"its inputs take more than {MAX_HEADER_BYTES >> 20} MiB")
        header = json.loads(bytes(arrays["header"]))
        recording = recording_from_header(header, arrays["poses"], arrays["counts"])
    except OSError:
        raise
    except Exception as error:  # noqa: BLE001 - whatever a damaged archive makes zipfile, numpy and json raise
        raise RecordingError(f"{file}: not a recording of the kit, or damaged ({error}).") from None
    return recording


def recording_from_header(header: Mapping[str, Any], poses: NDArray[Any], counts: NDArray[Any]) -> Recording:
    """The recording of this header and these arrays. Raises ValueError, KeyError or TypeError where they are damaged."""
    if header["format"] != FORMAT:
        raise ValueError(f"made by another version of the kit, format {header['format']}")
    if poses.dtype != np.float64 or counts.dtype != np.int64:
        raise ValueError(f"arrays of {poses.dtype} and {counts.dtype}")
    recording = Recording(
        str(header["place"]),
        None if header["case"] is None else str(header["case"]),
        int(header["seed"]),
        float(header["step_size"]),
        tuple((int(tick), tuple(names)) for tick, names in header["models"]),
        tuple(map(_read_input, header["inputs"])),
        poses.reshape(-1, 3),
        counts,
        None if header["level"] is None else str(header["level"]),
    )
    _check_parts_fit(recording)
    return recording


def _check_parts_fit(recording: Recording) -> None:
    """ValueError where the parts do not fit together."""
    counts = recording.counts
    if not 0 < recording.step_size < math.inf:
        raise ValueError(f"a step of {recording.step_size} s")
    if recording.step_size * len(counts) > MAX_TIME_S:
        raise ValueError(
            f"{recording.ticks} ticks of {recording.step_size} s each, more than {MAX_TIME_S} s in all"
        )
    if counts.ndim != 1 or (counts < 0).any() or counts.sum() != len(recording.poses):
        raise ValueError("the number of poses does not fit the models and ticks")
    unknown = {entry.kind for entry in recording.inputs} - {ACCEPT, *SERVICES}
    if unknown:
        raise ValueError(f"an input of unknown kind {min(unknown)}")


def rerun(recording: Recording, world: World) -> Recording:
    """Runs ``world`` again with the same inputs at the same ticks, and records that.

    Raises RecordingError where an input does not fit the world.
    """
    simulation = Simulation(
        world, seed=recording.seed, step_size=recording.step_size, has_subscribers=lambda topic: False
    )
    recorder = Recorder(recording.place, recording.case, simulation, recording.level)
    runner = Runner(simulation, Graph(log_sink=lambda record: None))
    playback = Playback(recording, runner.accept, runner.call_service)
    runner.participants.append(playback)
    runner.observers += [playback, recorder]
    run_until(runner, ticks=recording.ticks)
    return recorder.recording()


class Fingerprint(Observer):
    """Digest of the poses of all bodies at all steps: equal for equal runs, different for different ones."""

    def __init__(self) -> None:
        self._digest = hashlib.sha256()
        self.steps = 0
        """Steps made so far; resets do not restart this."""

    def on_step(self, simulation: Simulation) -> None:
        self.steps += 1
        for pose in simulation.poses():
            self._digest.update(struct.pack("<3d", *pose))

    @property
    def text(self) -> str:
        """16 hexadecimal digits."""
        return self._digest.hexdigest()[:16]


class Playback(Observer):
    """Replays a recording's inputs, in place of a controller: both a participant and an observer of the runner.

    ``accept(topic, message)`` and ``call_service(service, *arguments)`` deliver them; ``on_end`` is called after the
    recording's last tick.
    """

    def __init__(
        self,
        recording: Recording,
        accept: Callable[[str, Message], object],
        call_service: Callable[..., object],
        on_end: Callable[[], object] = lambda: None,
    ) -> None:
        self._inputs = list(reversed(recording.inputs))
        self._ticks = recording.ticks
        self._accept = accept
        self._call_service = call_service
        self._on_end = on_end
        self._tick = 0

    def exchange(self) -> bool:
        """Delivers the inputs of the coming tick. Raises RecordingError for one that does not fit the world."""
        while self._inputs and self._inputs[-1].tick <= self._tick:
            entry = self._inputs.pop()
            try:
                if entry.kind == ACCEPT:
                    self._accept(entry.content[0], _decode_message(*entry.content[1:]))
                else:
                    self._call_service(entry.kind, *entry.content)
            except (SimulationError, LookupError, ValueError, TypeError, AttributeError) as error:
                raise RecordingError(
                    f"The input before tick {entry.tick} is not possible in this world ({entry.kind}: {error})."
                ) from None
        return False

    def on_step(self, simulation: Simulation) -> None:
        self._tick += 1
        if self._tick == self._ticks:
            self._on_end()


def _decode_message(kind: str, content: Mapping[str, Any]) -> Message:
    interface = find_interface(kind)
    if not issubclass(interface, Message):
        raise TypeError(f"{kind} is not a message type")
    return from_dict(interface, content)
