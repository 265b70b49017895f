"""The leaderboard of one machine: a shared folder with one file per user who has joined.

Joining is voluntary. A file counts only if its owner is the user it is named after, so users cannot write for one
another. It holds names and times only, and leaving deletes it. The times are those that each player's own kit has
recorded: users who edit their own journal or file can claim any time, but only for themselves. The leaderboard is
therefore for friends, and must not be used for marks.
"""

from __future__ import annotations

import json
import os
import stat
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

from kit.school.game.medal import Medal
from kit.school.game.player_progress import DAILY_PREFIX, LevelProgress
from kit.school.game.race import DriverKind
from kit.workspace import open_common_folder, write_atomically

DEFAULT_FOLDER: Final = (
    "/var/tmp/robot-learning-kit-hall"  # for all users of a machine, and kept over a restart
)
FOLDER_VARIABLE: Final = "KIT_HALL"
MAX_FILE_SIZE: Final = 1024 * 1024
MAX_NAME_LENGTH: Final = 40
TRACK_STEP: Final = 0.2
"""Between two poses of a shared track [s]."""
MAX_TRACK_LENGTH: Final = 3000
MAX_COORDINATE: Final = 1e4


class LeaderboardError(Exception):
    """The leaderboard cannot be used; the message says why."""


@dataclass(frozen=True, slots=True)
class LeaderboardEntry:
    """The best time of one user on one level, by who drove."""

    name: str
    level: str
    driver: DriverKind
    seconds: float
    stars: int
    """Number of stars for extra rules."""
    is_mine: bool
    medal: Medal = Medal.NONE
    track: tuple[tuple[float, float, float], ...] = ()
    """The first robot's poses every ``TRACK_STEP`` [m, m, rad]; may be empty."""
    user: int = 0
    """The number of the user whose it is."""


@dataclass(frozen=True, slots=True)
class PlayerStanding:
    """What one user has won on all levels."""

    name: str
    medals: Mapping[Medal, int]
    """How many of each."""
    stars: int
    """Number of stars for extra rules."""
    fastest: int
    """Levels on which nobody on the leaderboard was quicker."""
    is_mine: bool


def standings(entries: Sequence[LeaderboardEntry]) -> list[PlayerStanding]:
    """Ranks all users who have joined: by gold medals, then silver ones, bronze ones and stars; the level of the day counts
    for none. ``entries``: in the order of ``read_entries``."""
    entries = [each for each in entries if not each.level.startswith(DAILY_PREFIX)]
    first: dict[str, int] = {}
    for entry in entries:
        first.setdefault(entry.level, entry.user)
    found = []
    for user in {entry.user: None for entry in entries}:
        own = [entry for entry in entries if entry.user == user]
        found.append(
            PlayerStanding(
                own[0].name,
                {medal: sum(entry.medal is medal for entry in own) for medal in Medal},
                sum({entry.level: entry.stars for entry in own}.values()),
                sum(quickest == user for quickest in first.values()),
                own[0].is_mine,
            )
        )
    best_first = (Medal.GOLD, Medal.SILVER, Medal.BRONZE)
    return sorted(
        found, key=lambda each: ([-each.medals[medal] for medal in best_first], -each.stars, each.name)
    )


def leaderboard_folder() -> Path:
    """The folder: ``$KIT_HALL``, or one that all users of the machine can write to."""
    return Path(os.environ.get(FOLDER_VARIABLE) or DEFAULT_FOLDER)


def has_joined(folder: Path) -> bool:
    """Whether this user has joined. The file must be theirs: another user could have made one of that name."""
    try:
        return _own_file(folder).lstat().st_uid == os.getuid()
    except OSError:
        return False


def publish_entry(
    folder: Path,
    name: str,
    levels_progress: Sequence[LevelProgress],
    tracks: Mapping[tuple[str, str], Sequence[Sequence[float]]] = MappingProxyType({}),
) -> None:
    """Adds or updates this user's entry. ``tracks``: by level and driver. Raises LeaderboardError."""
    levels = {
        each.level.id: {
            "stars": each.star_count,
            "best": {driver.value: time for driver, time in each.best_times.items()},
            "medals": {driver.value: medal.value for driver, medal in each.medals.items()},
            "tracks": {
                driver.value: tracks[each.level.id, driver.value]
                for driver in each.best_times
                if len(tracks.get((each.level.id, driver.value), ())) <= MAX_TRACK_LENGTH
                and (each.level.id, driver.value) in tracks
            },
        }
        for each in levels_progress
        if each.best_times
    }
    try:
        if problem := open_common_folder(folder):
            raise LeaderboardError(f"{folder}: {problem}.")
        write_atomically(_own_file(folder), _encode(name[:MAX_NAME_LENGTH], levels))
    except OSError as error:
        raise LeaderboardError(
            f"{folder}: the leaderboard cannot be written to ({error.strerror})."
        ) from None


def _encode(name: str, levels: Mapping[str, Mapping[str, Any]]) -> bytes:
    """The content of a user's file, without the longest tracks where it would be too large to be read."""
    content = {"name": name, "levels": levels}
    excess = len(json.dumps(content).encode()) - MAX_FILE_SIZE
    tracks = [(each["tracks"], driver) for each in levels.values() for driver in each["tracks"]]
    for of_level, driver in sorted(tracks, key=lambda found: -len(found[0][found[1]])):
        if excess <= 0:
            break
        excess -= len(json.dumps(of_level.pop(driver)))
    return json.dumps(content).encode()


def remove_own_entry(folder: Path) -> None:
    """Deletes this user's entry. Raises LeaderboardError."""
    try:
        _own_file(folder).unlink(missing_ok=True)
    except OSError as error:
        raise LeaderboardError(f"{folder}: {error.strerror}.") from None


def read_entries(folder: Path) -> list[LeaderboardEntry]:
    """Reads all entries, sorted by level and time. Skips files that are malformed or not owned by the user they name."""
    entries: list[LeaderboardEntry] = []
    with suppress(OSError):
        for file in sorted(folder.glob("*.json")):
            with suppress(
                OSError, ValueError, KeyError, TypeError, AttributeError, OverflowError, RecursionError
            ):
                entries.extend(_read_file(file))
    return sorted(entries, key=lambda each: (each.level, each.seconds, each.name))


def _read_file(file: Path) -> Iterator[LeaderboardEntry]:
    handle = os.open(file, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC)
    with os.fdopen(handle, "rb") as opened:
        status = os.fstat(handle)
        if (
            not stat.S_ISREG(status.st_mode)
            or file.name != f"{status.st_uid}.json"
            or status.st_size > MAX_FILE_SIZE
        ):
            return
        content: Mapping[str, Any] = json.loads(opened.read(MAX_FILE_SIZE))
    name = " ".join("".join(sign for sign in str(content["name"]) if sign.isprintable()).split())[
        :MAX_NAME_LENGTH
    ]
    entries = [
        LeaderboardEntry(
            name or f"user {status.st_uid}",
            str(level),
            DriverKind(driver),
            float(seconds),
            int(each["stars"]),
            status.st_uid == os.getuid(),
            Medal(each["medals"].get(driver, 0)),
            _read_track(each["tracks"].get(driver, ())),
            status.st_uid,
        )
        for level, each in content["levels"].items()
        for driver, seconds in each["best"].items()
    ]
    yield from (entry for entry in entries if 0 < entry.seconds < float("inf"))


def _read_track(rows: Sequence[Sequence[float]]) -> tuple[tuple[float, float, float], ...]:
    """The poses of a shared track. Raises ValueError for anything else."""
    poses = tuple((float(x), float(y), float(theta)) for x, y, theta in rows[:MAX_TRACK_LENGTH])
    if not all(abs(number) < MAX_COORDINATE for pose in poses for number in pose):  # also nan and inf
        raise ValueError("a pose that is nowhere")
    return poses


def _own_file(folder: Path) -> Path:
    return folder / f"{os.getuid()}.json"
