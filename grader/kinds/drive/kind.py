"""A manual drive recorded by ``kit drive --record``: replayed from its inputs, then graded like any other drive.

The poses in the file prove nothing. What counts is where the same inputs lead in the grader's own world; ``genuine``
measures how far that is from what the file claims. A reset begins a new attempt, and the best attempt is graded. ::

    drive: {place: simple, case: simple, time: 180}
"""

from __future__ import annotations

import io
import math
import zipfile
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

import numpy as np

from grader.assignment import Assignment
from grader.check import NoParams, check
from grader.driving.check_table import CHECKS
from grader.driving.drive_record import GradedDrive
from grader.evidence.contract import (
    Evidence,
    EvidenceCollector,
    EvidenceOptions,
    EvidenceRecord,
    FixedEvidence,
)
from grader.evidence.submission_clock import SubmissionClock
from grader.kinds.contract import AssignmentFiles, KindSettings, SubmissionKind
from grader.kinds.controller.kind import read_scenario
from grader.kinds.drive.sheet_keys import SHEET_KEYS
from grader.submitted_files import reading_submission
from kit.array_archives import READ_ERRORS, check_arrays
from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.wire import printable
from kit.msg.geometry_msgs import Twist
from kit.plain_files import read_plain_file
from kit.ros.graph.graph import Graph
from kit.run.episode import run_until
from kit.run.metrics import DriveMetrics, MetricsRecorder
from kit.run.recording import (
    ACCEPT,
    Fingerprint,
    Playback,
    Recorder,
    Recording,
    RecordingError,
    load_recording,
)
from kit.run.runner import Runner
from kit.run.scenario import Scenario
from kit.sim.simulation import Simulation

STEP: Final = 0.01
"""s: the tick of the kit's own programs."""
MAX_TIME_S: Final = 600.0
"""s: the longest time an assignment may allow."""
MAX_BYTES: Final = 64 << 20
"""Bytes of the file, unpacked."""
MAX_INPUTS_PER_S: Final = 100
"""Inputs per second on average; no manual drive has more."""
HAND_SPEED: Final = 0.5
HAND_TURN_RATE: Final = 1.5
"""m/s, rad/s: the keys give no more, as ``kit/controllers/teleop.py`` has it."""
HOME_TOLERANCE: Final = 1e-6
"""A robot may be reset to within this distance of its home [m, rad], and nowhere else."""
HEADER: Final = "header.npy"
HEADER_BYTES: Final = 64 * 1024
"""Bytes of a recording's header without its inputs."""
MAX_INPUT_BYTES: Final = 400
"""Bytes of one input in the header."""
ARRAYS: Final = MappingProxyType({HEADER: 1, "poses.npy": 2, "counts.npy": 1})
"""The arrays in a recording's file, with their numbers of dimensions."""


@dataclass(frozen=True, slots=True)
class HandDriveTask:
    """The scenario of the drive and its time limit."""

    scenario: Scenario | None
    """None only if the assignment has a mistake."""
    time_s: float
    """The longest recording that is accepted [s]."""


@dataclass(frozen=True, eq=False)
class ReplayedDrive(GradedDrive):
    """One attempt of a recording, as its replay came out."""

    max_deviation: float = field(default=math.inf)
    """The largest difference [m] between the file's poses and the replay's."""


@check(none=0.01, full=1e-6, unit="m")
def genuine(drive: ReplayedDrive, params: NoParams) -> float:
    """The same commands lead somewhere else: the robot is up to {actual} away from where your recording says. Was the
    file changed, or the map? Drive again and hand in the file as the kit wrote it."""
    return drive.max_deviation


def read_settings(files: AssignmentFiles) -> KindSettings:
    """Reads the scenario and the time limit."""
    section = files.public.section("drive")
    made = HandDriveTask(
        read_scenario(section, files.folder), section.number("time", 180.0, above=0, maximum=MAX_TIME_S)
    )
    section.finish()
    return KindSettings(task=made)


def collect(
    assignment: Assignment, file: Path, options: EvidenceOptions
) -> AbstractContextManager[EvidenceCollector]:
    """Replays the recording once. No program of the student's is involved."""
    try:
        with reading_submission(file.name, RecordingError, OSError, RecursionError, OverflowError):
            recording = _load_checked(assignment.task, file)
        evidence: Evidence = _rerun(assignment.task, recording, options.clock)
    except StudentCodeError as error:
        evidence = EvidenceRecord(failure=error.failure)
    except (RecordingError, OSError, MemoryError, RecursionError, OverflowError) as error:
        # The path of the temporary copy means nothing to the student.
        message = printable(str(error).replace(f"{file}", file.name))
        evidence = EvidenceRecord(failure=Failure(FailureKind.IMPORT, message or "It cannot be read."))
    return nullcontext(FixedEvidence([evidence], options.level))


def _load_checked(task: HandDriveTask, file: Path) -> Recording:
    """Loads the recording of a drive in the right scenario. Raises RecordingError for anything else."""
    data = read_plain_file(file, MAX_BYTES)
    if not data:
        raise RecordingError(f"{file.name} is empty: no drive has been recorded yet.")
    _check_size(data, file.name, task.time_s)
    recording = load_recording(file)
    scenario = task.scenario
    assert scenario is not None  # the assignment has no mistake
    case = None if scenario.case is None else scenario.case.name
    if recording.place != scenario.name or recording.case != case:
        was = " ".join(filter(None, (recording.place, recording.case)))
        wanted = " ".join(filter(None, (scenario.name, case)))
        raise RecordingError(f"This is a drive at {was}; the task asks for one at {wanted}.")
    if (
        recording.level is not None
    ):  # its world may be another one, with ice or carts: nothing that a task is posed on
        raise RecordingError(
            f"This is a drive of the game's level {recording.level}; the task asks for one on the map itself: "
            f"kit drive {scenario.name}{'' if case is None else f' --case {case}'} --controller teleop --record {file.name}"
        )
    if recording.step_size != STEP or recording.seed < 0:
        raise RecordingError(f"Its ticks last {recording.step_size} s; those of the kit last {STEP} s.")
    if recording.ticks == 0:
        raise RecordingError("Nothing happens in this recording: it was left before the robot could move.")
    if recording.ticks * STEP > task.time_s:
        raise RecordingError(
            f"It lasts {recording.ticks * STEP:.0f} s; at most {task.time_s:.0f} s are taken. Leave the screen when "
            "you have arrived."
        )
    if len(recording.inputs) > MAX_INPUTS_PER_S * (1 + recording.ticks * STEP):
        raise RecordingError("It has more commands than anyone can give by hand.")
    names = tuple(model.name for model in scenario.world.models)
    if recording.models != ((0, names),):
        raise RecordingError("It has other models in it than the map.")
    return recording


def _check_size(data: bytes, name: str, time_s: float) -> None:
    """Checks that reading the arrays takes no more memory than their bytes. Raises RecordingError."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = archive.infolist()
            if sorted(each.filename for each in members) != sorted(ARRAYS):
                raise ValueError(f"it must contain {', '.join(ARRAYS)} and nothing else")
            header = next(each for each in members if each.filename == HEADER)
            if header.file_size > HEADER_BYTES + MAX_INPUT_BYTES * MAX_INPUTS_PER_S * (1 + time_s):
                raise ValueError("it has more commands than anyone can give by hand")
            for file, shape in check_arrays(archive, MAX_BYTES).items():
                if len(shape) != ARRAYS[file]:
                    raise ValueError(f"{file} is not what it says")
    except READ_ERRORS as error:
        raise RecordingError(f"{name}: not a recording of the kit, or damaged ({error}).") from None


@dataclass(frozen=True, slots=True)
class _Attempt:
    first: int
    after: int
    """Ticks."""
    score: DriveMetrics

    @property
    def rank(self) -> tuple[bool, float, float]:
        """Orders attempts: first those that arrive, by fewest bumps, then time; else by distance to the target."""
        score = self.score
        if score.reached_s is not None:
            return True, -score.bumps, -score.reached_s
        return False, -(score.target_m or 0.0), score.distance_m


class _Rerun:
    """Replays the recording in the grader's world; only inputs that the keyboard can give are allowed."""

    def __init__(self, task: HandDriveTask, recording: Recording, clock: SubmissionClock) -> None:
        assert task.scenario is not None
        self._clock = clock
        self._scenario = task.scenario
        simulation = Simulation(
            task.scenario.world, seed=recording.seed, step_size=STEP, has_subscribers=lambda topic: False
        )
        self._runner = Runner(simulation, Graph(log_sink=lambda record: None))
        self._recording = recording
        self._metrics = MetricsRecorder.for_scenario(task.scenario)
        self._recorder = Recorder(recording.place, recording.case, simulation)
        ends = simulation.model_endpoints(task.scenario.robot or "")
        self._topics = {end.topic for end in ends if end.direction == "subscribe" and end.type is Twist}
        self.fingerprint = Fingerprint()
        self.poses = np.empty((0, len(task.scenario.world.models), 3))
        """(ticks, models, 3): where everything was, once it has been run."""

    def attempts(self) -> list[_Attempt]:
        """Replays the recording and returns its attempts. Raises RecordingError, and StudentCodeError where it takes too
        long."""
        playback = Playback(self._recording, self._accept, self._call_service)
        self._runner.participants.append(playback)
        self._runner.observers += [playback, self._metrics, self.fingerprint, self._recorder]
        resets = {entry.tick for entry in self._recording.inputs if entry.kind == "reset"}
        found: list[_Attempt] = []

        def split(tick: int) -> None:
            first = found[-1].after if found else 0
            if tick in resets and tick > first:
                found.append(_Attempt(first, tick, self._metrics.metrics))

        run_until(
            self._runner,
            ticks=self._recording.ticks,
            ends=(self._clock.end_condition,),
            before_tick=split,
        )
        self._clock.check()
        self.poses = self._recorder.recording().poses.reshape(self._recording.ticks, -1, 3)
        first = found[-1].after if found else 0
        return [*found, _Attempt(first, self._recording.ticks, self._metrics.metrics)]

    def _accept(self, topic: str, message: Any) -> None:
        if topic not in self._topics or not isinstance(message, Twist):
            raise ValueError(f"no robot is driven by messages on {topic}")
        if not all(map(math.isfinite, (message.linear.x, message.linear.y, message.angular.z))):
            raise ValueError("a speed that is not a number")
        fastest = max(abs(message.linear.x), abs(message.linear.y))
        if fastest > HAND_SPEED or abs(message.angular.z) > HAND_TURN_RATE:
            raise ValueError("faster than the keys drive")
        self._runner.accept(topic, message)

    def _call_service(self, service: str, *arguments: Any) -> None:
        if service != "reset" and not self._is_going_home(service, arguments):
            raise ValueError("only the keys drive here")
        self._runner.call_service(service, *arguments)

    def _is_going_home(self, service: str, arguments: tuple[Any, ...]) -> bool:
        home = self._scenario.start
        if service != "move_model" or home is None or len(arguments) != 2:
            return False
        name, pose = arguments
        return name == self._scenario.robot and all(
            abs(wanted - home_value) <= HOME_TOLERANCE for wanted, home_value in zip(pose, home, strict=True)
        )


def _rerun(task: HandDriveTask, recording: Recording, clock: SubmissionClock) -> ReplayedDrive:
    """Replays the recording and returns its best attempt. Raises RecordingError and StudentCodeError."""
    assert task.scenario is not None
    run = _Rerun(task, recording, clock)
    best = max(run.attempts(), key=lambda attempt: attempt.rank)
    claimed = recording.poses.reshape(recording.ticks, -1, 3)
    deviation = float(np.abs(claimed - run.poses).max()) if claimed.shape == run.poses.shape else math.inf
    ticks = slice(best.first, best.after)
    return ReplayedDrive(
        trial="drive",
        label="your recording",
        seed=recording.seed,
        secret=False,
        scenario=task.scenario,
        limit_s=task.time_s,
        recording=_cut_attempt(recording, run.poses[ticks], best.first),
        score=best.score,
        failure=None,
        traffic={},
        refused=(),
        printed=(),
        fingerprint=run.fingerprint.text,
        level=0,
        max_deviation=deviation if math.isfinite(deviation) else math.inf,
    )


def _cut_attempt(recording: Recording, poses: np.ndarray[Any, np.dtype[np.float64]], first: int) -> Recording:
    """Returns one attempt as a recording of its own, with the replay's poses."""
    ticks, models, _ = poses.shape
    inputs = tuple(
        entry for entry in recording.inputs if entry.kind == ACCEPT and first <= entry.tick < first + ticks
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


KIND: Final = SubmissionKind(
    (".npz",),
    MappingProxyType({**CHECKS, genuine.name: genuine}),
    read_settings,
    collect,
    sheet_keys=SHEET_KEYS,
    exercise="01-drive/flag",
)
