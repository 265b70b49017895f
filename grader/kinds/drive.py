"""A drive by hand, as ``kit play --record`` keeps it: run again from its inputs, then judged like any other drive.

The poses in the file prove nothing. What counts is where the same inputs lead in a world of ours; ``genuine`` says
how far that is from what the file claims. After a reset the drive begins anew: the best attempt is judged. ::

    drive: {place: simple, case: simple, time: 180}
"""

from __future__ import annotations

import io
import math
import zipfile
import zlib
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.lib import format as npy

from grader.assignment import Assignment
from grader.checks.contract import NoParams, check
from grader.checks.drives import CHECKS
from grader.evidence.drive_record import Drive
from grader.kinds.contract import Conditions, Look, Looks, Sheet, Sort, Task
from grader.kinds.controller import place_of
from kit.host.failure import Failure, FailureKind
from kit.host.wire import printable
from kit.msg.geometry_msgs import Twist
from kit.run.headless import Fingerprint
from kit.run.metrics import Score, Trip
from kit.run.recording import ACCEPT, Playback, Recording, RecordingError, load
from kit.run.scenario import Place
from kit.sim.services import tell
from kit.sim.simulation import Simulation

if TYPE_CHECKING:
    from grader.grading import Evidence, Gatherer

STEP: Final = 0.01
"""s: as the kit's own faces tick."""
LONGEST: Final = 600.0
"""s that may be asked for."""
MOST_BYTES: Final = 64 << 20
"""Of the file, unpacked."""
MOST_INPUTS: Final = 100
"""A second, on average; more were never driven by hand."""
HOME_HAIR: Final = 1e-6
"""A robot that has bumped is sent this near to its home [m, rad], and nowhere else."""
PARTS: Final = MappingProxyType({"header.npy": 1, "poses.npy": 2, "counts.npy": 1})
"""What a recording's file holds: arrays of so many dimensions."""


@dataclass(frozen=True, slots=True)
class Stage:
    """The kind's task."""

    place: Place | None
    """None only where the sheet is wrong."""
    time_s: float
    """No recording may be longer."""


@dataclass(frozen=True, eq=False)
class HandDrive(Drive):
    """One attempt of a recording, as it came out when it was run again."""

    off_m: float = field(default=math.inf)
    """How far, at worst, the file's poses are from ours."""


@check(none=0.01, full=1e-6, unit="m")
def genuine(drive: HandDrive, params: NoParams) -> float:
    """The same commands lead somewhere else: the robot is up to {actual} away from where your recording says. Was the
    file changed, or the map? Drive again and hand in the file as the kit wrote it."""
    return drive.off_m


def read(sheet: Sheet) -> Task:
    """Where the drive must have taken place."""
    section = sheet.public.section("drive")
    made = Stage(place_of(section, sheet.folder), section.number("time", 180.0, above=0, maximum=LONGEST))
    section.finish()
    return Task(content=made)


def gather(assignment: Assignment, file: Path, conditions: Conditions) -> AbstractContextManager[Gatherer]:
    """Runs the recording again, once. No program of the student's is involved."""
    try:
        seen: Evidence = _again(assignment.task, _checked(assignment.task, file))
    except (RecordingError, OSError, MemoryError, RecursionError, OverflowError) as error:
        # Where the snapshot lies is nothing to tell.
        message = printable(str(error).replace(f"{file}", file.name))
        seen = Look(failure=Failure(FailureKind.IMPORT, message or "It cannot be read."))
    return nullcontext(Looks([seen], conditions.level))


def _checked(stage: Stage, file: Path) -> Recording:
    """The recording, if it is one of a drive at the right place. Raises RecordingError."""
    data = file.read_bytes()
    if not data:
        raise RecordingError(f"{file.name} is empty: no drive has been recorded yet.")
    _check_size(data, file.name)
    recording = load(file)
    place = stage.place
    assert place is not None  # the sheet is right
    case = None if place.case is None else place.case.name
    if recording.place != place.name or recording.case != case:
        was = " ".join(filter(None, (recording.place, recording.case)))
        wanted = " ".join(filter(None, (place.name, case)))
        raise RecordingError(f"This is a drive at {was}; the task asks for one at {wanted}.")
    if recording.step_size != STEP or recording.seed < 0:
        raise RecordingError(f"Its ticks last {recording.step_size} s; those of the kit last {STEP} s.")
    if recording.ticks == 0:
        raise RecordingError("Nothing happens in this recording: it was left before the robot could move.")
    if recording.ticks * STEP > stage.time_s:
        raise RecordingError(
            f"It lasts {recording.ticks * STEP:.0f} s; at most {stage.time_s:.0f} s are taken. Leave the screen when "
            "you have arrived."
        )
    if len(recording.inputs) > MOST_INPUTS * (1 + recording.ticks * STEP):
        raise RecordingError("It holds more commands than anybody can give by hand.")
    names = tuple(model.name for model in place.world.models)
    if recording.models != ((0, names),):
        raise RecordingError("It has other models in it than the map.")
    return recording


def _check_size(data: bytes, name: str) -> None:
    """That reading the arrays takes no more memory than their bytes. Raises RecordingError."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = archive.infolist()
            if sorted(each.filename for each in members) != sorted(PARTS):
                raise ValueError(f"it must hold {', '.join(PARTS)} and nothing else")
            if sum(each.file_size for each in members) > MOST_BYTES:
                raise ValueError(f"it is larger than {MOST_BYTES >> 20} MiB, unpacked")
            for each in members:
                with archive.open(each) as part:
                    if npy.read_magic(part) != (1, 0):
                        raise ValueError("an array of an unknown version")
                    shape, _, kind = npy.read_array_header_1_0(part)
                    size = math.prod(shape) * kind.itemsize
                    if kind.hasobject or len(shape) != PARTS[each.filename] or size > each.file_size:
                        raise ValueError(f"{each.filename} is not what it says")
    except (ValueError, LookupError, TypeError, EOFError, NotImplementedError, RuntimeError) as error:
        raise RecordingError(f"{name}: not a recording of the kit, or a damaged one ({error}).") from None
    except (zipfile.BadZipFile, zlib.error, OSError) as error:
        raise RecordingError(f"{name}: not a recording of the kit, or a damaged one ({error}).") from None


@dataclass(frozen=True, slots=True)
class _Attempt:
    first: int
    after: int
    """Ticks."""
    score: Score

    @property
    def rank(self) -> tuple[bool, float, float]:
        """The higher the better: arrived with few bumps, and soon; else near to the target, or far driven."""
        score = self.score
        if score.reached_s is not None:
            return True, -score.bumps, -score.reached_s
        return False, -(score.target_m or 0.0), score.distance_m


class _Run:
    """The recording in a world of ours; only what a hand at the keys can do is done."""

    def __init__(self, stage: Stage, recording: Recording) -> None:
        assert stage.place is not None
        self._place = stage.place
        self._simulation = Simulation(
            stage.place.world, seed=recording.seed, step_size=STEP, wanted=lambda topic: False
        )
        self._recording = recording
        self._trip = Trip(stage.place.driven, stage.place.case)
        ends = self._simulation.endpoints_of(stage.place.robot or "")
        self._topics = {end.topic for end in ends if end.direction == "subscribe" and end.type is Twist}
        self.fingerprint = Fingerprint()
        self.poses = np.empty((recording.ticks, len(stage.place.world.models), 3))

    def attempts(self) -> list[_Attempt]:
        """Runs it. Raises RecordingError."""
        playback = Playback(self._recording, self._accept, self._tell)
        resets = {told.tick for told in self._recording.inputs if told.kind == "reset"}
        found, first = [], 0
        for tick in range(self._recording.ticks):
            if tick in resets and tick > first:
                found.append(_Attempt(first, tick, self._trip.score))
                first = tick
            playback.exchange()
            self._simulation.step()
            playback.on_step(self._simulation)
            self._trip.on_step(self._simulation)
            self.fingerprint.on_step(self._simulation)
            self.poses[tick] = self._simulation.poses()
        return [*found, _Attempt(first, self._recording.ticks, self._trip.score)]

    def _accept(self, topic: str, message: Any) -> None:
        if topic not in self._topics or not isinstance(message, Twist):
            raise ValueError(f"nobody drives with messages on {topic}")
        if not all(map(math.isfinite, (message.linear.x, message.linear.y, message.angular.z))):
            raise ValueError("a speed that is no number")
        self._simulation.accept(topic, message)

    def _tell(self, service: str, *arguments: Any) -> None:
        if service != "reset" and not self._is_going_home(service, arguments):
            raise ValueError("only the keys drive here")
        tell(self._simulation, service, *arguments)
        self._trip.on_service(service, *arguments)

    def _is_going_home(self, service: str, arguments: tuple[Any, ...]) -> bool:
        home = self._place.start
        if service != "move_model" or home is None or len(arguments) != 2:
            return False
        name, pose = arguments
        return name == self._place.robot and all(
            abs(wanted - there) <= HOME_HAIR for wanted, there in zip(pose, home, strict=True)
        )


def _again(stage: Stage, recording: Recording) -> HandDrive:
    """The best attempt, as it comes out here. Raises RecordingError."""
    assert stage.place is not None
    run = _Run(stage, recording)
    best = max(run.attempts(), key=lambda attempt: attempt.rank)
    claimed = recording.poses.reshape(recording.ticks, -1, 3)
    off = float(np.abs(claimed - run.poses).max()) if claimed.shape == run.poses.shape else math.inf
    some = slice(best.first, best.after)
    return HandDrive(
        trial="drive",
        label="your recording",
        seed=recording.seed,
        secret=False,
        place=stage.place,
        limit_s=stage.time_s,
        recording=_part(recording, run.poses[some], best.first),
        score=best.score,
        failure=None,
        talk={},
        refused=(),
        printed=(),
        fingerprint=run.fingerprint.text,
        level=0,
        off_m=off if math.isfinite(off) else math.inf,
    )


def _part(recording: Recording, poses: np.ndarray[Any, np.dtype[np.float64]], first: int) -> Recording:
    """One attempt as a recording of its own, with the poses that came out."""
    ticks, models, _ = poses.shape
    inputs = tuple(
        told for told in recording.inputs if told.kind == ACCEPT and first <= told.tick < first + ticks
    )
    return Recording(
        recording.place,
        recording.case,
        recording.seed,
        recording.step_size,
        recording.models,
        inputs,
        poses.reshape(-1, 3),
        np.full(ticks, models, dtype=np.int64),
    )


SORT: Final = Sort((".npz",), MappingProxyType({**CHECKS, genuine.name: genuine}), read, gather)
