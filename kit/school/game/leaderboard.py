"""The leaderboard of one machine: a shared folder in which users who have joined put a name and the inputs of their drives.

Joining is voluntary, and leaving deletes what was put there. A file counts only if its owner is the user it is named after,
so users cannot write for one another. No file says a time: everybody's own kit runs the drives again and judges them
(``shared_drives``). That a person, and not a script, pressed the keys of a drive by hand nobody can tell: the leaderboard is
for friends, and must not be used for marks.
"""

from __future__ import annotations

import datetime
import hashlib
import json
import os
import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Final

from kit.arrays import FloatArray
from kit.plain_files import open_plain_file
from kit.run.recording import Recording
from kit.school.game.daily import DAILY_PREFIX, daily_id, daily_level, today, yesterday
from kit.school.game.levels import GameLevel, all_levels
from kit.school.game.medal import RUNGS, Medal
from kit.school.game.race import DriverKind
from kit.school.game.shared_drives import (
    MAX_FILE_BYTES,
    TRACK_STRIDE,
    DriveRefused,
    JudgedDrive,
    digest_of,
    is_same_way,
    judge_shared_drives,
    read_shared_drives,
    share_drives,
    unpacked_size,
)
from kit.workspace import open_common_folder, write_atomically

DEFAULT_FOLDER: Final = (
    "/var/tmp/robot-learning-kit-hall"  # for all users of a machine, and kept over a restart
)
FOLDER_VARIABLE: Final = "KIT_HALL"
MAX_NAME_LENGTH: Final = 40
MAX_NAME_BYTES: Final = 4096
"""Of the file with a user's name."""
MAX_USER_DIGITS: Final = 12
DIGEST_ENDING: Final = re.compile(r"\.[0-9a-f]{16}\.npz$")
"""The end of the name of a file that tells since when a drive was on the board."""
LEFT: Final = "a player who has left"
MAX_FORMER: Final = 50
"""So many drives of one user by one driver on one level are compared with those of others, the oldest ones."""
MAX_JUDGED: Final = 4096
"""Drives whose judgement is kept in memory."""
MAX_TICKS_OF_ONE_USER: Final = 100_000
"""Ticks of one user's drives that are run again for each level that is read, about ten seconds of processor time: what is
beyond them is passed over, so that nobody makes others wait for hours."""
TICKS_OF_A_FILE: Final = 500
"""What reading a file costs, at least."""
BYTES_OF_A_TICK: Final = 300
"""So many bytes of a file, unpacked, take as long to read and to run as a tick: of a small file of one letter, unpacked to
megabytes, they are nearly all that it costs."""


class LeaderboardError(Exception):
    """The leaderboard cannot be used; the message says why."""


@dataclass(frozen=True, slots=True, eq=False)
class LeaderboardEntry:
    """The best drive of one user on one level, by who drove, as it was judged here."""

    name: str
    level: str
    driver: DriverKind
    seconds: float
    stars: int
    """Number of stars for extra rules, of those that a drive itself shows."""
    is_mine: bool
    medal: Medal = Medal.NONE
    tracks: tuple[FloatArray, ...] = ()
    """The poses of each driven robot (k, 3) [m, m, rad], ``step_size`` [s] apart."""
    way: tuple[FloatArray, ...] = ()
    """As in ``JudgedDrive``."""
    step_size: float = 0.1
    user: int = 0
    """The number of the user whose it is."""
    since_ns: int = 0
    """Since when its file stands there, by the folder's own clock [ns]."""
    is_same_platform: bool = True
    """Whether it was driven on a machine like this one; else the referee's judgement stands, not equality to the bit."""
    copy_of: str = ""
    """Who had the same drive of a program before; empty: nobody."""


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
    """Ranks all users who have joined: by records, then master, gold, silver and bronze medals, and stars; the level of the day counts
    for none, and what another had before does not count. ``entries``: in the order of ``read_entries``."""
    entries = [each for each in entries if not each.level.startswith(DAILY_PREFIX) and not each.copy_of]
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
    best_first = tuple(reversed(RUNGS))
    return sorted(
        found, key=lambda each: ([-each.medals[medal] for medal in best_first], -each.stars, each.name)
    )


def leaderboard_folder() -> Path:
    """The folder: ``$KIT_HALL``, or one that all users of the machine can write to."""
    return Path(os.environ.get(FOLDER_VARIABLE) or DEFAULT_FOLDER)


def has_joined(folder: Path) -> bool:
    """Whether this user has joined. The file must be theirs: another user could have made one of that name."""
    try:
        return _name_file(folder, os.getuid()).lstat().st_uid == os.getuid()
    except OSError:
        return False


def publish_drives(
    folder: Path,
    name: str,
    drives: Mapping[tuple[str, DriverKind], Sequence[Recording]],
) -> None:
    """Adds or renews this user's name and drives. ``drives``: by level and driver; of a program those from all starts.
    Raises LeaderboardError."""
    try:
        if problem := open_common_folder(folder):
            raise LeaderboardError(f"{folder}: {problem}.")
        content = json.dumps({"name": name[:MAX_NAME_LENGTH]}).encode()
        write_atomically(_name_file(folder, os.getuid()), content, follows_links=False)
        for (level, driver), recordings in drives.items():
            file = _drive_file(folder, os.getuid(), level, driver)
            share_drives(recordings, file)
            # What is driven later takes the place of the first file, but never of this one: a copy of it is younger.
            digest = hashlib.sha256("".join(map(digest_of, recordings)).encode()).hexdigest()
            share_drives(recordings, file.with_suffix(f".{digest[:16]}.npz"))
    except OSError as error:
        raise LeaderboardError(
            f"{folder}: the leaderboard cannot be written to ({error.strerror})."
        ) from None


def remove_own_entry(folder: Path) -> None:
    """Takes this user's name, drives and answers of puzzles off the board. What tells since when a drive was theirs is kept, so
    that a copy of it does not become the first one. Raises LeaderboardError."""
    try:
        _name_file(folder, os.getuid()).unlink(missing_ok=True)
        for pattern in ("npz", "txt"):
            for file in folder.glob(f"{os.getuid()}.*.{pattern}"):
                if not DIGEST_ENDING.search(file.name):
                    file.unlink(missing_ok=True)
    except OSError as error:
        raise LeaderboardError(f"{folder}: {error.strerror}.") from None


def own_name(folder: Path) -> str:
    """The name under which this user has joined; empty if they have not."""
    return _read_name(folder, os.getuid()) or ""


def read_entries(folder: Path, levels: Sequence[GameLevel] | None = None) -> list[LeaderboardEntry]:
    """Judges the drives of all who have joined, by default on all levels, that of the day and that of the day before, where only what
    stood there on its day counts; sorted by level and time.
    Passes over what may not stand there, and what is another's drive by hand. Takes about a second for twenty drives that were not judged before."""
    names = _user_names(folder)
    read = levels if levels is not None else (*all_levels(), *_days_on_board(folder))
    users = {**names, **dict.fromkeys(_drivers(folder))}
    judges = {user: _Judge(user, MAX_TICKS_OF_ONE_USER * len(read)) for user in users}
    entries = [
        _make_entry(name, user, level, driver, *judged)
        for user, name in names.items()
        for level in read
        for driver in DriverKind
        if (judged := judges[user].judge(_standing_file(folder, user, level.id, driver), level, driver))
        is not None
        and _stood_on_its_day(level, judged[1])
    ]
    lengths: dict[str, set[int]] = {}
    for entry in entries:
        lengths.setdefault(entry.level, set()).update(map(len, entry.tracks))
    former = [
        _make_entry(names.get(user, LEFT), user, level, driver, *judged)
        for user in users
        for level in read
        for driver in DriverKind
        if (wanted := lengths.get(level.id))
        for file in _former_files(_drive_file(folder, user, level.id, driver))
        if (judged := judges[user].judge(file, level, driver, wanted)) is not None
    ]
    told = _without_copies(entries, former)
    return sorted(told, key=lambda each: (each.level, each.seconds, bool(each.copy_of), each.name))


def _make_entry(
    name: str, user: int, level: GameLevel, driver: DriverKind, judged: JudgedDrive, since_ns: int
) -> LeaderboardEntry:
    return LeaderboardEntry(
        name,
        level.id,
        driver,
        judged.finish.seconds,
        len(judged.rules),
        user == os.getuid(),
        judged.medal,
        judged.tracks,
        judged.way,
        judged.step_size,
        user,
        since_ns,
        judged.is_same_platform,
    )


def users_of(folder: Path) -> Iterator[int]:
    """The numbers of the users who have joined."""
    with suppress(OSError):
        for file in sorted(folder.glob("*.json")):
            if file.stem.isdecimal() and len(file.stem) < MAX_USER_DIGITS:
                yield int(file.stem)


def _drivers(folder: Path) -> set[int]:
    """The numbers of the users of whom a drive was ever on the board, also of those who have left it."""
    with suppress(OSError):
        found = (
            each.name.partition(".")[0] for each in folder.glob("*.npz") if DIGEST_ENDING.search(each.name)
        )
        return {int(user) for user in found if user.isdecimal() and len(user) < MAX_USER_DIGITS}
    return set()


def _user_names(folder: Path) -> dict[int, str]:
    """The names of the users who have joined; where several have one name, it is told whose it is."""
    names = {user: name for user in users_of(folder) if (name := _read_name(folder, user)) is not None}
    taken = Counter(name.casefold() for name in names.values())
    return {
        user: f"{name} (user {user})" if taken[name.casefold()] > 1 else name for user, name in names.items()
    }


def _read_name(folder: Path, user: int) -> str | None:
    """The name in a user's own file; None if there is none."""
    with suppress(OSError, ValueError, KeyError, TypeError, RecursionError):
        content = json.loads(read_own(_name_file(folder, user), user, MAX_NAME_BYTES))
        name = "".join(sign for sign in str(content["name"]) if sign.isprintable())
        return " ".join(name.split())[:MAX_NAME_LENGTH] or f"user {user}"
    return None


def _former_files(file: Path) -> list[Path]:
    """The files of all that was ever put in place of a drive's file, the oldest first."""
    with suppress(OSError):
        found = file.parent.glob(f"{file.stem}.*.npz")
        return sorted(found, key=lambda each: each.lstat().st_ctime_ns)[:MAX_FORMER]
    return []


class _Judge:
    """Judges the drives of one user, for as many ticks as are left."""

    def __init__(self, user: int, ticks: int) -> None:
        self._user = user
        self._ticks_left = ticks
        self._seen: set[tuple[bytes, str, DriverKind]] = set()

    def judge(
        self, file: Path, level: GameLevel, driver: DriverKind, lengths: Collection[int] | None = None
    ) -> tuple[JudgedDrive, int] | None:
        """A shared drive of a level, run again, and since when it stands there [ns]; None if there is none that may.

        ``lengths``: of the tracks that it is to be compared with: one that is as long as none of them is not run.
        """
        if self._ticks_left <= 0:
            return None
        try:
            content, since_ns = read_own(file, self._user, MAX_FILE_BYTES), file.lstat().st_ctime_ns
            # On another level it is run once more.
            if (seen := (hashlib.sha256(content).digest(), level.id, driver)) not in self._seen:
                self._seen.add(seen)
                self._ticks_left -= TICKS_OF_A_FILE + unpacked_size(content) // BYTES_OF_A_TICK
                if self._ticks_left < 0:
                    return None
                ticks = [each.ticks for each in read_shared_drives(content).recordings]
                if lengths is not None and not _is_as_long(ticks, lengths):
                    return None
                self._ticks_left -= sum(ticks)
            judged = _judge_once(content, level, driver)
        except (OSError, DriveRefused):
            return None
        return None if judged is None else (judged, since_ns)


def _standing_file(folder: Path, user: int, level: str, driver: DriverKind) -> Path:
    """The file of the drive that stands for a user: the last one, but of a day's level the first that was put there, also where
    it was driven once more in another workspace."""
    file = _drive_file(folder, user, level, driver)
    if level.startswith(DAILY_PREFIX) and file.is_file():
        with suppress(OSError):
            return next((each for each in _former_files(file) if each.lstat().st_uid == user), file)
    return file


def _days_on_board(folder: Path) -> Iterator[GameLevel]:
    """Today's level, and yesterday's where anybody has driven it."""
    yield daily_level(today())
    if any(folder.glob(f"*.{daily_id(yesterday())}.*")):
        yield daily_level(yesterday())


def _stood_on_its_day(level: GameLevel, since_ns: int) -> bool:
    """Whether a drive was put there before its level was over, as yesterday's is."""
    there = datetime.datetime.fromtimestamp(since_ns / 1e9).astimezone().date()
    return level.id != daily_id(yesterday()) or there < today()


def _is_as_long(ticks: Iterable[int], lengths: Collection[int]) -> bool:
    """Whether one of several drives is about as long as one of these tracks."""
    return any(abs(each // TRACK_STRIDE - length) <= 2 for each in ticks for length in lengths)


def _without_copies(
    entries: Sequence[LeaderboardEntry], former: Sequence[LeaderboardEntry]
) -> list[LeaderboardEntry]:
    """Leaves out drives by hand that another user had before, by whatever driver and however much sooner or later, or whose user has a
    program or an agent that drives the same: no hand does. Two programs may well be equal, so theirs are kept, and told whose they
    are, also where one is called an agent. The system keeps the time at which a file was last changed, so
    that no user can set it back. ``former``: every drive that was ever put on the board, also by those who have left it."""
    earliest = sorted([*entries, *former], key=lambda entry: (entry.since_ns, entry.user))
    since: dict[tuple[int, str, DriverKind, float], int] = {}
    for each in earliest:
        since.setdefault((each.user, each.level, each.driver, each.seconds), each.since_ns)
    kept: list[LeaderboardEntry] = []
    for each in entries:
        own_since = since[each.user, each.level, each.driver, each.seconds]
        first = next(
            (
                other
                for other in earliest
                if other.level == each.level
                and (
                    (other.since_ns, other.user) < (own_since, each.user)
                    if other.user != each.user
                    else other.driver is not each.driver is DriverKind.HAND
                )
                and is_same_way(each.way, other.way)
            ),
            None,
        )
        if first is None:
            kept.append(each)
        elif each.driver is not DriverKind.HAND:
            kept.append(replace(each, copy_of=first.name))
    return kept


@lru_cache(MAX_JUDGED)
def _judge_once(content: bytes, level: GameLevel, driver: DriverKind) -> JudgedDrive | None:
    """Judges the content of a file once; None if it is refused."""
    with suppress(DriveRefused):
        return judge_shared_drives(content, level, driver)
    return None


def read_own(file: Path, user: int, limit: int) -> bytes:
    """The content of a plain file that belongs to the user it is named after. Raises OSError for any other."""
    with open_plain_file(file, follows_links=False) as opened:
        status = os.fstat(opened.fileno())
        content = opened.read(limit + 1)
    if status.st_uid != user or len(content) > limit:
        raise OSError(f"{file} is not that user's, or too large")
    return content


def _name_file(folder: Path, user: int) -> Path:
    return folder / f"{user}.json"


def _drive_file(folder: Path, user: int, level: str, driver: DriverKind) -> Path:
    return folder / f"{user}.{level}.{driver.value}.npz"
