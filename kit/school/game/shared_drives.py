"""Drives as others may see them: the inputs of recordings, which whoever reads them runs again and has judged.

A file says nothing of a time or a medal, so nothing of it can be claimed: what stands on a board is what the referee of the
reader's own kit has seen. On the platform of the driver a drive must be the same to the bit; on another one the referee's
judgement counts, and is marked.
"""

from __future__ import annotations

import hashlib
import io
import json
import os
import platform
import zipfile
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from kit.array_archives import READ_ERRORS, unpack_arrays
from kit.arrays import FloatArray
from kit.plain_files import open_plain_file
from kit.run.recording import (
    ACCEPT,
    Input,
    Recording,
    RecordingError,
    recording_from_header,
    recording_header,
)
from kit.school.game.levels import GameLevel
from kit.school.game.medal import Medal, medal_of
from kit.school.game.player_progress import BY_HAND, ExtraRule, kept_rules
from kit.school.game.race import ALLOWED_SERVICES, DriverKind, RaceFinish, middle_drive, run_again
from kit.school.game.references import reference_recording, reference_seconds
from kit.school.game.starts import OWN_SEED, STARTS, are_drawn, scenario_from
from kit.sim.simulation import STEP_SIZE_S, Simulation
from kit.workspace import write_atomically
from kit.world.records import World

FORMAT: Final = 1
TRACK_STRIDE: Final = 10
"""One of this many poses of a track is kept."""
SAME_WAY: Final = 0.005
"""Two drives that are nowhere farther apart than this are one [m]."""
SET_OFF: Final = 0.0225
"""A robot that is this far from the start has set off [m]: between two ticks' ways at full speed, so that a drive that is a
hair slower has set off in the same tick."""
MAX_FILE_BYTES: Final = 4 << 20
MAX_INPUTS_BYTES: Final = 16 << 20
"""Bytes of a file's inputs, unpacked: one command in each tick of the five drives of a program."""


class DriveRefused(ValueError):
    """A file is no drive that may stand on a board; the message says why."""


@dataclass(frozen=True, slots=True, eq=False)
class JudgedDrive:
    """A shared drive, run again and judged."""

    finish: RaceFinish
    """Of a program's drives the one that counts."""
    medal: Medal
    rules: tuple[ExtraRule, ...]
    """Extra rules of which the drive itself shows that they were kept."""
    tracks: tuple[FloatArray, ...]
    """The poses of each driven robot (k, 3) [m, m, rad], ``step_size`` [s] apart."""
    way: tuple[FloatArray, ...]
    """Where each was (k, 2) [m] in the drive from the level's own start, from when the first of them had set off: the same for
    a copy that waits first, and for a copied program, whose other starts are other ones."""
    step_size: float
    is_same_platform: bool
    """Whether it was driven on this platform, and so is the same to the bit."""


def platform_key() -> str:
    """What two machines must have in common so that a run is the same on both, to the bit."""
    versions = f"numpy {np.__version__}, Python {platform.python_version()}"
    return f"{platform.system()} {platform.machine()}, {versions}"


def share_drives(recordings: Sequence[Recording], file: Path, remarks: Sequence[str] = ()) -> None:
    """Writes what ``pack_drives`` packs, whole or not at all. Raises OSError."""
    content = pack_drives(recordings, remarks)
    if not _holds(file, content):  # else it stays as old as it is
        write_atomically(file, content, follows_links=False)


def pack_drives(recordings: Sequence[Recording], remarks: Sequence[str] = ()) -> bytes:
    """Packs the inputs of a driver's recordings of one level as a file. ``remarks``: what went wrong with each program."""
    content = {
        "format": FORMAT,
        "platform": platform_key(),
        "drives": [
            {
                **recording_header(replace(each, inputs=_inputs_that_count(each.inputs))),
                "ticks": each.ticks,
                "digest": digest_of(each),
            }
            for each in recordings
        ],
        "remarks": list(remarks),
    }
    data = io.BytesIO()
    np.savez_compressed(data, drives=np.frombuffer(json.dumps(content).encode(), dtype=np.uint8))
    return data.getvalue()


def _inputs_that_count(inputs: Sequence[Input]) -> tuple[Input, ...]:
    """The inputs without the messages that another one follows in the same tick, on the same topic: robots obey the last. So
    nobody can send so many that a drive cannot be shared, and a lost match does not count."""
    kept: list[Input] = []
    following: set[str] = set()
    tick = None
    for each in reversed(inputs):
        if each.tick != tick or each.kind != ACCEPT:
            tick = each.tick
            following.clear()
        if each.kind == ACCEPT:
            if each.content[0] in following:
                continue
            following.add(each.content[0])
        kept.append(each)
    return tuple(reversed(kept))


def _holds(file: Path, content: bytes) -> bool:
    """Whether a file of this user's has this content."""
    try:
        with open_plain_file(file, follows_links=False) as opened:
            is_own = os.fstat(opened.fileno()).st_uid == os.geteuid()
            return is_own and opened.read(len(content) + 1) == content
    except OSError:
        return False


def judge_shared_drives(data: bytes, level: GameLevel, driver: DriverKind) -> JudgedDrive:
    """Runs the drives of a file of ``share_drives`` again and judges them. Raises DriveRefused."""
    shared = read_shared_drives(data)
    drives = drives_again(shared, level, driver)
    counts = middle_drive([finish for finish, _ in drives])
    finish, again = drives[counts]
    if not finish.reached:
        raise DriveRefused("it does not reach the goal")
    robots = scenario_from(level, again.seed).partners
    tracks = tuple(again.track(name)[::TRACK_STRIDE] for name in robots)
    way = _way_of(level, next(each for _, each in drives if each.seed == OWN_SEED))
    if driver is DriverKind.HAND and _is_reference(level, way):
        raise DriveRefused("it is the reference drive")
    return JudgedDrive(
        finish,
        medal_of(finish, reference_seconds(level), driver),
        kept_rules(level, finish, BY_HAND),
        tracks,
        way,
        TRACK_STRIDE * again.step_size,
        shared.is_same_platform,
    )


def drives_again(
    shared: SharedDrives, level: GameLevel, driver: DriverKind
) -> list[tuple[RaceFinish, Recording]]:
    """Runs the drives of a level again: one of a hand, from the level's own start, of others one from each start. Raises
    DriveRefused."""
    seeds = sorted(each.seed for each in shared.recordings)
    if driver is DriverKind.HAND and seeds != [OWN_SEED]:
        raise DriveRefused("it is not one drive from the level's own start")
    if driver is not DriverKind.HAND and not are_drawn(level, seeds):
        raise DriveRefused(f"it has not one drive from each of {STARTS} starts")
    drives = []
    for number, recording in enumerate(shared.recordings):
        try:
            scenario = scenario_from(level, recording.seed)
        except ValueError as error:
            raise DriveRefused(str(error)) from None
        check_inputs(recording, scenario.world, scenario.partners, level.time_limit, ALLOWED_SERVICES)
        try:
            finish, again = run_again(level, recording)
        except (ValueError, RecordingError) as error:
            raise DriveRefused(str(error)) from None
        shared.check_same(number, again)
        drives.append((finish, again))
    return drives


@dataclass(frozen=True, slots=True, eq=False)
class SharedDrives:
    """The content of a file of ``share_drives``."""

    is_same_platform: bool
    recordings: tuple[Recording, ...]
    """Without poses."""
    digests: tuple[str, ...]
    """Of their poses."""
    remarks: tuple[str, ...]
    """What went wrong with each program, where that was noted; a board takes nothing from them."""

    def check_same(self, number: int, again: Recording) -> None:
        """Raises DriveRefused if a drive, run again, is another one; on another platform it may be."""
        if self.is_same_platform and digest_of(again) != self.digests[number]:
            raise DriveRefused("run again, it is another drive")


def read_shared_drives(data: bytes) -> SharedDrives:
    """Reads a file of ``share_drives``. Raises DriveRefused."""
    content = _read_drives_archive(data)
    try:
        digests = tuple(str(each["digest"]) for each in content["drives"])
    except KeyError as error:
        raise DriveRefused(f"a drive is damaged ({error})") from None
    recordings = tuple(_stripped_recording(each) for each in content["drives"])
    remarks = tuple(map(str, content["remarks"]))
    return SharedDrives(content["platform"] == platform_key(), recordings, digests, remarks)


def unpacked_size(data: bytes) -> int:
    """The bytes to which a file of ``share_drives`` unpacks, by what it says itself. Raises DriveRefused."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            return sum(each.file_size for each in archive.infolist())
    except READ_ERRORS as error:
        raise DriveRefused(f"it is damaged ({error})") from None


def _read_drives_archive(data: bytes) -> dict[str, Any]:
    """The content of a file. Raises DriveRefused."""
    if len(data) > MAX_FILE_BYTES:
        raise DriveRefused("it is too large")
    try:
        # A number counts as 8 bytes, and these are bytes.
        packed = unpack_arrays(data, 8 * MAX_INPUTS_BYTES)["drives"]
        if packed.nbytes > MAX_INPUTS_BYTES:
            raise DriveRefused("it is too large")
        content = json.loads(bytes(packed))
        if content["format"] != FORMAT or not isinstance(content["platform"], str):
            raise DriveRefused("it was shared by another version of the kit")
        if (
            not all(isinstance(each, dict) for each in content["drives"])
            or type(content["remarks"]) is not list
        ):
            raise DriveRefused("it holds something other than drives")
    except DriveRefused:
        raise
    except (*READ_ERRORS, RecursionError, UnicodeDecodeError) as error:
        raise DriveRefused(f"it is damaged ({error})") from None
    return dict(content)


def _stripped_recording(entry: Mapping[str, Any]) -> Recording:
    """A shared drive as a recording without poses."""
    try:
        ticks = int(entry["ticks"])
        if not 0 <= ticks <= 10**6:
            raise ValueError(f"{ticks} ticks")
        header = {**entry, "models": []}
        return recording_from_header(header, np.empty((0, 3)), np.zeros(ticks, dtype=np.int64))
    except (KeyError, ValueError, TypeError, AttributeError, OverflowError) as error:
        raise DriveRefused(f"a drive is damaged ({error})") from None


def check_inputs(
    recording: Recording,
    world: World,
    robots: Sequence[str],
    time_limit: float,
    services: Collection[str] = (),
) -> None:
    """Raises DriveRefused for a drive with another clock, or inputs that are no commands to these robots. ``time_limit``: of
    the drive [s]. ``services``: those that may have been called."""
    if recording.step_size != STEP_SIZE_S or recording.ticks * recording.step_size > time_limit + 1.0:
        raise DriveRefused("its clock is not that of the level")
    simulation = Simulation(world, seed=OWN_SEED, has_subscribers=lambda topic: False)
    topics = {topic for robot in robots for topic in simulation.command_topics(robot)}
    for each in recording.inputs:
        if each.kind == ACCEPT:
            if not each.content or type(each.content[0]) is not str or each.content[0] not in topics:
                raise DriveRefused("it moves something other than its robots")
        elif each.kind not in services:
            raise DriveRefused(f"the world was changed during the race ({each.kind})")


def _way_of(level: GameLevel, recording: Recording) -> tuple[FloatArray, ...]:
    """Where each driven robot was, from when the first of them had set off: ``JudgedDrive.way``."""
    robots = scenario_from(level, recording.seed).partners
    tracks = [recording.track(name)[:, :2] for name in robots]
    has_set_off = np.max([np.hypot(*(each - each[:1]).T) for each in tracks], axis=0) > SET_OFF
    return tuple(each[np.argmax(has_set_off) :: TRACK_STRIDE] for each in tracks)


def _is_reference(level: GameLevel, way: Sequence[FloatArray]) -> bool:
    """Whether a drive goes where the reference drive goes: no hand does."""
    reference = reference_recording(level)
    return reference is not None and is_same_way(way, _way_of(level, reference))


def is_same_way(way: Sequence[FloatArray], other: Sequence[FloatArray]) -> bool:
    """Whether two drives are at the same places at the same times after they set off, all but a hair."""
    if len(way) != len(other):
        return False
    for one, another in zip(way, other, strict=True):
        rows = min(len(one), len(another))
        if abs(len(one) - len(another)) > 1 or np.abs(one[:rows] - another[:rows]).max() > SAME_WAY:
            return False
    return True


def digest_of(recording: Recording) -> str:
    """Equal for drives whose poses are equal to the bit."""
    return hashlib.sha256(np.ascontiguousarray(recording.poses).tobytes()).hexdigest()
