"""A league's folder: who is entered, on which levels all meet all, and the recordings of what they drove.

Whoever owns the folder runs the matches, and only files of the owner count as results; others may enter and look. A result
holds commands, never a score: everybody's own kit runs the recordings again, and judges them. A programme's races are driven
by each entrant alone, from the starts of every program, so a match compares two drives; a drive ends after five times the
reference drive's time, and once more than half of its drives have not arrived, an entrant drives no more on that level: its
middle drive has not arrived either. At tag two programs share one world, and each pair plays twice, so that each of them begins
once as the catcher. Nothing depends on the time of day.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
import stat
import threading
from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from functools import cache, lru_cache
from itertools import permutations
from pathlib import Path
from random import Random
from typing import Any, ClassVar, Final

from kit import __version__
from kit.controllers import ControllerFile
from kit.host.job_executors import JobPool, in_shard, read_result
from kit.host.job_folder import JobFolder
from kit.host.private_folder import private_folder
from kit.host.python_command import python_command
from kit.host.sandbox.limits import GRADER_LIMITS
from kit.host.sandbox.probe import is_level_available
from kit.host.sandbox.sandbox_config import Level as Confinement
from kit.plain_files import open_plain_file, read_plain_file
from kit.run.recording import Recorder, Recording, RecordingError
from kit.school.game.league.entries import FOLDER as ENTRIES
from kit.school.game.league.entries import (
    MANIFEST,
    Entry,
    LeagueError,
    house_entries,
    read_entries,
    record_holders,
)
from kit.school.game.league.tag_game import play_tag, tag_again, tag_scenario
from kit.school.game.levels import GameLevel, UnknownLevel, find_level
from kit.school.game.race import DriverKind, RaceFinish, race_controller
from kit.school.game.references import reference_seconds
from kit.school.game.shared_drives import (
    MAX_FILE_BYTES,
    DriveRefused,
    check_inputs,
    drives_again,
    pack_drives,
    platform_key,
    read_shared_drives,
)
from kit.school.game.starts import STARTS, draw_seeds, scenario_from
from kit.school.game.two_players import TAG_RULE, TAG_SECONDS, CannotShare, SharedPhase
from kit.sim.simulation import Simulation
from kit.workspace import Workspace, make_private_folder, open_common_folder, write_atomically

FOLDER_VARIABLE: Final = "KIT_LEAGUE"
MAX_MANIFEST_BYTES: Final = 1 << 16
RESULTS: Final = "results"
RACES: Final = ("left-turn", "parking", "slalom", "racetrack")
"""Levels of a new league's races."""
TAG: Final = ("two-doors", "the-forest")
"""Levels on which a new league plays tag."""
RACE_LIMIT: Final = 5.0
"""A drive of a race ends after this many times the reference drive's time, or at the level's own limit."""
WALL_LIMIT_S: Final = 300.0
"""Of one drive [s of wall clock]."""
MAX_JUDGED: Final = 20_000
"""Results whose judgement is kept in memory."""
HOUSE_RESULTS: Final = Path(__file__).with_name("house_results")
"""What the programs of the house drive and play on the levels of a new league: results as in a league's folder, and what came of
each, which a test judges again."""
HOUSE_JUDGED: Final = HOUSE_RESULTS / "judged.json"
_RUNNING_AGAIN: Final = threading.Lock()
"""Held while recordings are run again: threads that compute side by side hold each other up."""


@dataclass(frozen=True, slots=True)
class Programme:
    """What a league's entrants do, and how far their programs are confined."""

    title: str
    races: tuple[GameLevel, ...]
    tag: tuple[GameLevel, ...]
    confinement: Confinement
    has_house: bool = True
    """Whether the programs of the house take part."""


@dataclass(frozen=True, slots=True)
class LeagueJob:
    """One drive of an entrant from all starts of a level, or one game of tag."""

    key: str
    level: GameLevel
    entrants: tuple[Entry, ...]
    """One for a drive; for a game of tag two, of which the first begins as the catcher."""

    @property
    def is_tag(self) -> bool:
        return len(self.entrants) > 1

    @property
    def expected_s(self) -> float:
        """About how long it is driven, in all [simulated s]."""
        return TAG_SECONDS if self.is_tag else 0.5 * STARTS * self.level.time_limit


@dataclass(frozen=True, slots=True)
class JudgedJob:
    """What came of a job, as its recordings have shown, run again."""

    finishes: tuple[RaceFinish, ...] = ()
    """Of the drives, one from each start."""
    scores: tuple[float, ...] = ()
    """Of a game: the seconds that count against each."""
    winner: int | None = None
    """Of a game; None if it was a draw."""
    remarks: tuple[str, ...] = ()
    """Why programs have stopped: of each drive, or of both entrants; empty where they have not."""
    is_same_platform: bool = True
    """Whether it was driven on a machine like this one, and so is the same to the bit."""


@dataclass(frozen=True, slots=True)
class League(JobFolder):
    """The folder of a league; its jobs are the drives and games that its entrants owe."""

    judgements: Path | None = None
    """Where this user keeps what was judged once; None: nowhere."""
    job_name: ClassVar[str] = "kit-league"

    @classmethod
    def make(
        cls, folder: Path, title: str, races: Sequence[str], tag: Sequence[str], *, has_house: bool = True
    ) -> League:
        """Makes a league's folder, to whose entries every user of the machine can add. Raises LeagueError."""
        league = cls(folder)
        if (folder / MANIFEST).exists():
            raise LeagueError(f"{folder} has a league already.")
        told = {"title": title, "races": list(races), "tag": list(tag)}
        content = json.dumps({**told, "confinement": int(Confinement.FILTERED), "house": has_house})
        programme = read_programme(content.encode(), folder)
        try:
            folder.mkdir(parents=True, exist_ok=True)
            if problem := open_common_folder(folder / ENTRIES):
                raise LeagueError(f"{folder / ENTRIES}: {problem}.")
            (folder / RESULTS).mkdir(mode=0o755, exist_ok=True)
        except OSError as error:
            raise LeagueError(f"{folder}: the league cannot be made ({error.strerror}).") from None
        league.change(programme)
        return league

    @property
    def is_mine(self) -> bool:
        """Whether this user owns it, and so runs its matches."""
        return self.owner == os.geteuid()

    @property
    def owner(self) -> int:
        """The number of the user whose results count. Raises LeagueError."""
        return self._check_manifest()

    def _check_manifest(self) -> int:
        """Returns whose file the league's list is. Raises LeagueError if there is none, and where another user than the folder's own
        could have put that file there in place of it."""
        try:
            folder, owner = self.folder.stat(), (self.folder / MANIFEST).lstat().st_uid
        except OSError:
            raise LeagueError(f"{self.folder}: there is no league; `kit league new` makes one.") from None
        is_replaceable = folder.st_mode & 0o022 and not folder.st_mode & stat.S_ISVTX
        if is_replaceable and owner != folder.st_uid:
            raise LeagueError(
                f"{self.folder}: its files can be replaced by others than their owners; chmod go-w it, or make the league in another folder."
            )
        return owner

    def programme(self) -> Programme:
        """Raises LeagueError."""
        self._check_manifest()
        try:
            content = read_plain_file(self.folder / MANIFEST, MAX_MANIFEST_BYTES)
        except OSError:
            raise LeagueError(f"{self.folder}: there is no league; `kit league new` makes one.") from None
        return read_programme(content, self.folder)

    def change(self, programme: Programme) -> None:
        """Sets what the entrants do, and how they are confined. Raises LeagueError."""
        content = {
            "title": programme.title,
            "races": [each.id for each in programme.races],
            "tag": [each.id for each in programme.tag],
            "confinement": int(programme.confinement),
            "house": programme.has_house,
        }
        try:
            write_atomically(self.folder / MANIFEST, (json.dumps(content, indent=1) + "\n").encode())
        except OSError as error:
            raise LeagueError(f"{self.folder}: {error.strerror}.") from None

    def entries(self) -> tuple[Entry, ...]:
        """All entries, and those of the house where they take part. Raises LeagueError."""
        return (*read_entries(self.folder), *(house_entries() if self.programme().has_house else ()))

    def entrants(self) -> list[Entry]:
        """The entries that take part. Raises LeagueError."""
        return [each for each in self.entries() if not each.problem]

    def jobs(self) -> list[LeagueJob]:
        """All that is driven: nothing while nobody meets anybody; of the house alone, and at tag between two of it, what comes with
        the kit. Races of short levels come first, so that there are soon matches and a rating. Raises LeagueError."""
        entrants, programme = self.entrants(), self.programme()
        is_house_alone = all(each.is_house for each in entrants)
        racing = entrants if len(entrants) > 1 else []
        jobs = [
            *(drive_job(level, each) for level in programme.races for each in racing),
            *(tag_job(level, *pair) for level in programme.tag for pair in permutations(entrants, 2)),
        ]
        due = [
            job
            for job in jobs
            if job.key in house_judgements()
            or not (is_house_alone or (job.is_tag and all(each.is_house for each in job.entrants)))
        ]
        return sorted(due, key=lambda job: job.expected_s)

    # What a job folder says

    @property
    def worker_command(self) -> list[str]:
        kept = [] if self.judgements is None else ["--judgements", str(self.judgements.absolute())]
        return python_command("kit", "league", "work", str(self.folder.absolute()), *kept)

    @property
    def shard_command(self) -> list[str]:
        return self.worker_command

    def keys(self) -> list[str]:
        return list(dict.fromkeys(job.key for job in self.jobs()))

    def is_waiting(self, key: str) -> bool:
        return key in self.waiting()

    def waiting(self, shard: tuple[int, int] = (0, 1)) -> tuple[str, ...]:
        waiting = dict.fromkeys(job.key for job in self.jobs() if self.judge(job) is None)
        return tuple(key for key in waiting if in_shard(key, shard))

    def run_job(self, key: str) -> None:
        """Drives or plays a job, and judges it for this user; its result is written whole or not at all. Raises OSError and
        LeagueError."""
        job = self._find_job(key)
        if job is None:
            return  # somebody has withdrawn meanwhile
        content = pack_drives(*run_league_job(job, self.programme().confinement))
        if self.judgements is not None:  # before others can see it, who would judge it once more
            _judge_once(self.judgements, content, job.level, len(job.entrants))
        write_atomically(self.result_file(key), content, follows_links=False)

    def _find_job(self, key: str) -> LeagueJob | None:
        return next((each for each in self.jobs() if each.key == key), None)

    def record_loss(self, key: str) -> None:
        """Leaves nothing: a job that was lost waits for the next run. Raises OSError where no result can be written, on a
        full disk, so that the others are not driven in vain."""
        trial = self.result_file(key).with_suffix(".trial")
        write_atomically(trial, bytes(4096))
        trial.unlink()

    def prepare_run(self) -> tuple[str, ...]:
        """Records whose name is whose, removes the results of those who have withdrawn, and returns the keys of the jobs that are
        to be run. Raises LeagueError where this user's results do not count, or the machine cannot confine programs as the
        league asks; and OSError."""
        if not self.is_mine:
            raise LeagueError(
                f"{self.folder} belongs to another user: only results of its owner count, so its owner runs it."
            )
        confinement = self.programme().confinement
        if not is_level_available(confinement):
            raise LeagueError(
                f"This machine cannot confine programs at level {confinement:d}. If all of them are your own: kit league run --level 0"
            )
        record_holders(self.folder)
        waiting = self.waiting()
        self.remove_stale_results()
        return waiting

    # Results

    def result_file(self, key: str) -> Path:
        return self.folder / RESULTS / f"{key}.npz"

    def judge(self, job: LeagueJob) -> JudgedJob | None:
        """What came of a job; None where it has no result that counts: it was not run, or the file is not the owner's or
        something other than commands that lead to what it shows. Raises LeagueError."""
        content = self._read_result(job)
        if content is None:
            return None
        if (shipped := house_judgements().get(job.key)) is not None:
            return replace(shipped, is_same_platform=read_shared_drives(content).is_same_platform)
        with _RUNNING_AGAIN:
            if self.judgements is None:
                return judge_result(content, job.level, len(job.entrants))
            return _judge_once(self.judgements, content, job.level, len(job.entrants))

    def unjudged(self) -> list[str]:
        """The keys of the jobs with a result whose judgement this user has not kept; none where none are kept. Raises
        LeagueError."""
        keys = []
        for job in self.jobs() if self.judgements is not None else ():
            content = None if job.key in house_judgements() else self._read_result(job)
            if content is not None and self.judgements is not None:
                file = _judgement_file(self.judgements, content, job.level, len(job.entrants))
                keys += [] if file.exists() else [job.key]
        return keys

    def judge_key(self, key: str) -> None:
        """Judges a job, so that its judgement is kept. Raises LeagueError."""
        job = self._find_job(key)
        if job is not None:
            self.judge(job)

    def judge_apart(self, keys: Sequence[str], on_done: Callable[[str], object]) -> None:
        """Judges jobs in processes of their own. ``on_done``: called with each key that is through, one at a time; what it raises
        ends this. Raises OSError."""
        command = [*self.worker_command, "--judge"]
        JobPool(command, keys, os.cpu_count() or 1, on_done, lambda key: None).run()

    def recordings(self, job: LeagueJob) -> tuple[Recording, ...]:
        """The recordings of a job, run again: of a drive from each start, of a game one. Raises LeagueError."""
        content = self._read_result(job)
        try:
            if content is None:
                raise DriveRefused("it is gone")
            with _RUNNING_AGAIN:
                return _rerun(content, job.level, len(job.entrants))[1]
        except (DriveRefused, RecordingError, ValueError) as error:
            raise LeagueError(f"This match cannot be shown: {error}.") from None

    def _read_result(self, job: LeagueJob) -> bytes | None:
        """The content of a job's result: of the house alone the kit's, where it has one; None if there is none of the owner's."""
        try:
            if job.key in house_judgements():
                return (HOUSE_RESULTS / f"{job.key}.npz").read_bytes()
            with open_plain_file(self.result_file(job.key), follows_links=False) as opened:
                content = opened.read(MAX_FILE_BYTES + 1)
                return content if os.fstat(opened.fileno()).st_uid == self.owner else None
        except OSError:
            return None

    def remove_stale_results(self) -> None:
        """Removes the results of those who have withdrawn or entered another program."""
        wanted = set(self.keys())
        for file in (self.folder / RESULTS).glob("*.npz"):
            if file.stem not in wanted:
                with suppress(OSError):
                    file.unlink()


def own_league(workspace: Workspace, folder: Path | None = None) -> League:
    """The league of a folder; by default that which ``$KIT_LEAGUE`` names, or one's own in the workspace, which is made where it
    is missing. Raises LeagueError."""
    named, judgements = folder or os.environ.get(FOLDER_VARIABLE), workspace.folder / "judgements"
    if named:
        return League(Path(named), judgements)
    own = workspace.folder / "league"
    if not (own / MANIFEST).exists():
        League.make(own, "Your league", RACES, TAG)
    return League(own, judgements)


def drive_job(level: GameLevel, entry: Entry) -> LeagueJob:
    """A drive of an entrant from all starts of a level."""
    return LeagueJob(_key("drive", level.id, entry.digest), level, (entry,))


def tag_job(level: GameLevel, first: Entry, second: Entry) -> LeagueJob:
    """A game of tag, which ``first`` begins as the catcher."""
    return LeagueJob(_key("tag", level.id, first.digest, second.digest), level, (first, second))


def run_league_job(job: LeagueJob, confinement: Confinement) -> tuple[list[Recording], list[str]]:
    """Runs a job's programs. Returns its recordings, and why programs have stopped: of each drive, or of both players."""
    with private_folder() as folder:  # the programs as they were entered, whatever their owners do meanwhile
        programs = [_copy_program(each, folder, number) for number, each in enumerate(job.entrants)]
        if len(programs) > 1:
            game = play_tag(job.level, programs, confinement, GRADER_LIMITS)
            return [game.recording], list(game.failures)
        recordings: list[Recording] = []
        remarks: list[str] = []
        lost = 0
        seeds = draw_seeds(job.level, Random(job.key))
        for seed in seeds:
            has_not_started = bool(recordings and remarks[0] and not recordings[0].ticks)
            if has_not_started or lost > len(seeds) // 2:
                recordings.append(_undriven(job.level, seed))
                remarks.append(remarks[0] if has_not_started else "")  # it would not start from here either
                continue
            finish, recording = race_controller(
                job.level,
                programs[0],
                wall_limit_s=WALL_LIMIT_S,
                seed=seed,
                confinement=confinement,
                limits=GRADER_LIMITS,
            )
            lost += not finish.reached
            recordings.append(recording)
            remarks.append("" if finish.failure is None else str(finish.failure))
    return recordings, remarks


def _undriven(level: GameLevel, seed: int) -> Recording:
    """The recording of a drive that does not take place: without a tick."""
    scenario = scenario_from(level, seed)
    simulation = Simulation(scenario.world, seed=seed, has_subscribers=lambda topic: False)
    return Recorder.for_scenario(scenario, simulation).recording()


def _copy_program(entry: Entry, folder: Path, number: int) -> ControllerFile:
    """An entrant's program as a file that nobody changes. Raises LeagueError if it is another one than was read."""
    part = folder / str(number)
    part.mkdir()
    file = part / f"{entry.name}.py"
    if entry.is_house:
        file.write_bytes(entry.house_program)
        return replace(entry.program, file=file)
    try:
        with open_plain_file(entry.file, follows_links=False) as opened:
            content = opened.read()
    except OSError as error:
        raise LeagueError(f"{entry.file}: {error.strerror}.") from None
    if hashlib.sha256(content).hexdigest() != entry.digest:
        raise LeagueError(f"{entry.file} has changed meanwhile: run the league again.")
    file.write_bytes(content)
    return replace(entry.program, file=file)


@lru_cache
def read_programme(content: bytes, folder: Path) -> Programme:
    """Reads a league's manifest, of equal content once: its levels' worlds are looked at. Raises LeagueError."""
    file = folder / MANIFEST
    try:
        told = json.loads(content)
        title, confinement = str(told["title"])[:80], Confinement(told["confinement"])
        has_house = bool(told["house"])
        names = {kind: [str(each) for each in told[kind]] for kind in ("races", "tag")}
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        raise LeagueError(
            f"{file}: a league has a title, races, tag (lists of levels), confinement and house ({error})."
        ) from None
    if not names["races"] and not names["tag"]:
        raise LeagueError(f"{file}: a league needs at least one level, in races or tag.")
    try:
        races, tag = (tuple(find_level(each) for each in dict.fromkeys(names[kind])) for kind in names)
        races = tuple(map(_with_race_limit, races))
        for level in tag:
            tag_scenario(level)
    except (UnknownLevel, CannotShare) as error:
        raise LeagueError(f"{file}: {error}") from None
    return Programme(title, races, tag, confinement, has_house)


def _with_race_limit(level: GameLevel) -> GameLevel:
    """A level whose drives end soon after all who arrive have arrived."""
    reference = reference_seconds(level)
    if reference is None:
        return level
    return replace(level, time_limit=min(level.time_limit, math.ceil(RACE_LIMIT * reference)))


def seconds_left(jobs: Collection[LeagueJob], done: Collection[str], gone_s: float) -> float | None:
    """How long the rest of some jobs takes, by those that are done after ``gone_s``; None while none is."""
    made = sum(each.expected_s for each in jobs if each.key in done)
    left = sum(each.expected_s for each in jobs if each.key not in done)
    return gone_s * left / made if made else None


@lru_cache(MAX_JUDGED)
def _judge_once(folder: Path, content: bytes, level: GameLevel, players: int) -> JudgedJob | None:
    """Judges the content of a result once, and keeps that in ``folder``: thousands of drives would take minutes each time."""
    file = _judgement_file(folder, content, level, players)
    with suppress(OSError, ValueError, KeyError, TypeError):
        return _read_judgement(read_result(file))
    judged = judge_result(content, level, players)
    with suppress(OSError):  # it is judged again next time
        make_private_folder(folder)
        write_atomically(file, json.dumps({"judged": None if judged is None else asdict(judged)}).encode())
    return judged


def _judgement_file(folder: Path, content: bytes, level: GameLevel, players: int) -> Path:
    """Where the judgement of a result's content is kept."""
    told = json.dumps(
        [__version__, platform_key(), repr(level), players, TAG_RULE, hashlib.sha256(content).hexdigest()]
    )
    return folder / f"{hashlib.sha256(told.encode()).hexdigest()[:32]}.json"


@cache
def house_judgements() -> Mapping[str, JudgedJob]:
    """What came of the results that come with the kit, by their jobs' keys."""
    found = {
        key: _read_judgement({"judged": told}) for key, told in json.loads(HOUSE_JUDGED.read_text()).items()
    }
    return {key: judged for key, judged in found.items() if judged is not None}


def _read_judgement(content: dict[str, Any]) -> JudgedJob | None:
    """What ``_judge_once`` has kept. Raises ValueError, KeyError or TypeError for anything else."""
    judged = content["judged"]
    if judged is None:
        return None
    finishes = tuple(RaceFinish(**{**each, "splits": tuple(each["splits"])}) for each in judged["finishes"])
    scores, remarks = tuple(map(float, judged["scores"])), tuple(map(str, judged["remarks"]))
    return JudgedJob(finishes, scores, judged["winner"], remarks, bool(judged["is_same_platform"]))


def judge_result(content: bytes, level: GameLevel, players: int) -> JudgedJob | None:
    """Judges the content of a result; None if it is refused."""
    with suppress(DriveRefused, RecordingError, ValueError):
        return _rerun(content, level, players)[0]
    return None


def _rerun(content: bytes, level: GameLevel, players: int) -> tuple[JudgedJob, tuple[Recording, ...]]:
    """Runs what a result holds again, and judges it. Raises DriveRefused, RecordingError and ValueError."""
    shared = read_shared_drives(content)
    if players == 1:
        drives = drives_again(shared, level, DriverKind.PROGRAM)
        finishes = tuple(finish for finish, _ in drives)
        judged = JudgedJob(finishes, remarks=shared.remarks, is_same_platform=shared.is_same_platform)
        return judged, tuple(recording for _, recording in drives)
    if len(shared.recordings) != 1:
        raise DriveRefused("it is not one game")
    scenario = tag_scenario(level)
    (recording,) = shared.recordings
    check_inputs(recording, scenario.world, scenario.drivers, TAG_SECONDS)
    state, again = tag_again(level, recording)
    shared.check_same(0, again)
    if state.phase is not SharedPhase.OVER:
        raise DriveRefused("the game was not played to its end")
    return JudgedJob((), state.scores, state.winner, shared.remarks, shared.is_same_platform), (again,)


def _key(*parts: str) -> str:
    return hashlib.sha256(json.dumps(parts).encode()).hexdigest()[:32]
