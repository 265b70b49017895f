"""Programs that keep something: how each is started, when there is something to keep, and how much of it is found.

All run in a ``Place``. What is kept is read back as a user would: by the next start of the kit.
"""

from __future__ import annotations

import json
import os
import pty
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import threading
import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing, suppress
from pathlib import Path
from types import MappingProxyType
from typing import ClassVar, Final, Protocol

from kit.inspection.sockets import running_worlds, sockets_folder
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.run_config import RunConfig
from kit.learning.training.run_folders import create_run
from kit.learning.training.runs import TrainingRun
from kit.learning.training.training_sweep import TrainingSweep
from kit.mapmaking.sketch_draft import SketchDraft
from kit.part_file import part_path, parts_in
from kit.ros.bag_storage import BagError, restore_bags
from kit.ros.bags import read_bag
from kit.run.recording import RecordingError, load_recording
from kit.run.recording_file import restore_recordings
from kit.school.game.shared_drives import read_shared_drives
from kit.school.progress import EventKind, ProgressJournal
from kit.study.result_logs import read_recorded_result
from kit.tui.widgets.program_editor import DRAFT_SUFFIX
from tests.grader.conftest import FORWARD, write_assignment
from tests.kills.scenarios import Place
from tests.waiting import wait_until


class Terminal(Protocol):
    """The terminal at which a program runs."""

    shown: bytearray
    """What the program has shown."""

    def write(self, typed: bytes) -> None:
        """Types. Raises OSError once the terminal is closed."""


class Recorder(ABC):
    """One program that keeps something, run once."""

    needs_terminal: ClassVar[bool] = False
    outlives_terminal: ClassVar[bool] = False
    """Whether it goes on when its terminal is closed, as trainings do."""

    def __init__(self, place: Place) -> None:
        self.place = place
        self.partner: subprocess.Popen[bytes] | None = None
        """A process without which there is nothing to record."""

    @property
    def folder(self) -> Path:
        """Where it writes."""
        return self.place.workspace

    @property
    @abstractmethod
    def words(self) -> Sequence[str]:
        """The command, without the interpreter."""

    @abstractmethod
    def has_something(self) -> bool:
        """Whether there is something on the disk that an end might lose."""

    @abstractmethod
    def kept(self) -> int:
        """How much is found afterwards, as the next start finds it."""

    def prepare(self) -> None:  # noqa: B027 - few need anything
        """Makes what the program needs."""

    def type_into(self, terminal: Terminal) -> None:  # noqa: B027 - to few is anything typed
        """What a user types, for a while."""

    def close(self) -> None:
        if self.partner is not None:
            self.partner.kill()
            self.partner.wait()


class RunRecording(Recorder):
    """``kit run --record``."""

    file = "run.npz"

    @property
    def words(self) -> Sequence[str]:
        return ("-m", "kit", "run", "maze", "--steps", "100000000", "--record", str(self.folder / self.file))

    def has_something(self) -> bool:
        part = part_path(self.folder / self.file)
        return part.exists() and part.read_bytes().count(b"\n") > 2

    def kept(self) -> int:
        """Ticks."""
        list(restore_recordings(self.folder))
        with suppress(FileNotFoundError, RecordingError):
            return load_recording(self.folder / self.file).ticks
        return 0


class PlayRecording(RunRecording):
    """``kit drive --plain --record``, driven line by line."""

    @property
    def words(self) -> Sequence[str]:
        drive = str(self.folder / self.file)
        return ("-m", "kit", "drive", "simple", "--plain", "--controller", "teleop", "--record", drive)

    def type_into(self, terminal: Terminal) -> None:
        for _ in range(400):
            terminal.write(b"drive 0.3 0 2\n")
            time.sleep(0.15)


class RunBag(Recorder):
    """``kit run --bag``."""

    storage: ClassVar[str] = "mcap"

    @property
    def bag(self) -> Path:
        return self.folder / "bag"

    @property
    def words(self) -> Sequence[str]:
        bag = ("--bag", str(self.bag), "-s", self.storage)
        return ("-m", "kit", "run", "maze", "--steps", "100000000", "--speed", "5", *bag)

    def has_something(self) -> bool:
        data = [path for path in part_path(self.bag).glob("bag_0/*") if path.suffix in (".mcap", ".db3")]
        return bool(data) and data[0].stat().st_size > 60_000

    def kept(self) -> int:
        """Messages."""
        list(restore_bags(self.folder))
        with suppress(BagError):
            return read_bag(self.bag).count
        return 0


class RunSqliteBag(RunBag):
    """``kit run --bag -s sqlite3``."""

    storage = "sqlite3"

    def has_something(self) -> bool:
        """Whether a copy of its files, from which what is not committed is rolled back, holds messages."""
        if not super().has_something():
            return False
        with tempfile.TemporaryDirectory() as folder, suppress(OSError, shutil.Error, sqlite3.Error):
            copy = shutil.copytree(part_path(self.bag) / "bag_0", Path(folder, "copy"))
            with closing(sqlite3.connect(next(copy.glob("*.db3")))) as opened:
                return bool(opened.execute("SELECT count(*) FROM messages").fetchone()[0])
        return False


class RosBag(RunBag):
    """``kit ros bag record``, of a world in another process."""

    @property
    def words(self) -> Sequence[str]:
        return ("-m", "kit", "ros", "bag", "record", "-a", "-o", str(self.bag))

    def prepare(self) -> None:
        world = ("-m", "kit", "run", "maze", "--serve", "--steps", "100000000")
        self.partner = self.place.start(*world, output=self.place.folder / "world.txt")
        wait_until(lambda: list(running_worlds(sockets_folder(self.place.workspace))), "the world")


class Training(Recorder):
    """The process that ``kit train`` starts: its events and its checkpoint."""

    outlives_terminal = True

    def prepare(self) -> None:
        (self.folder / "runs").mkdir(exist_ok=True)
        config = RunConfig(TaskSpec("turn"), "q-learning", steps=10**9, keep_training=True)
        self._run: TrainingRun = create_run(self.folder / "runs", config, "kept")

    @property
    def words(self) -> Sequence[str]:
        return ("-m", "kit.learning.training.worker", str(self._run.folder))

    def has_something(self) -> bool:
        return len(self._run.events()) > 3 and self._run.newest_policy.exists()

    def kept(self) -> int:
        """Events; none where a policy is damaged, or not there."""
        if not self._run.newest_policy.exists():
            return 0
        self._run.policy(newest=True)
        return len(self._run.events())


class Quiz(Recorder):
    """``kit quiz --plain``: the answers."""

    @property
    def words(self) -> Sequence[str]:
        return ("-m", "kit", "quiz", "--plain", "--again")

    def type_into(self, terminal: Terminal) -> None:
        for _ in range(400):
            terminal.write(b"1\n3\n")
            time.sleep(0.15)

    def has_something(self) -> bool:
        return self.kept() > 2

    def kept(self) -> int:
        """Answers."""
        if not (self.folder / "progress.db").exists():
            return 0
        with ProgressJournal(self.folder) as journal:
            return sum(event.kind is EventKind.ANSWER for event in journal.events())


class Cohort(Recorder):
    """``grader cohort``: the results of a class."""

    def prepare(self) -> None:
        self._in = self.place.folder / "in"
        self._in.mkdir(exist_ok=True)
        for number in range(40):
            source = FORWARD.replace("SPEED = 0.3", f"SPEED = {0.05 + 0.01 * number:.2f}")
            (self._in / f"s{number}.py").write_text(source)
        self._assignment = write_assignment(self.place.folder / "assignment")

    @property
    def words(self) -> Sequence[str]:
        folders = ("--assignment", str(self._assignment), "--queue", str(self.folder / "queue"))
        return ("-m", "grader", "cohort", str(self._in), "--jobs", "1", "--level", "0", *folders)

    def has_something(self) -> bool:
        return len(list(self.folder.glob("queue/results/*.json"))) > 1

    def kept(self) -> int:
        """Results that can be read."""
        files = self.folder.glob("queue/results/*.json")
        return sum(bool(json.loads(file.read_text())) for file in files)


class Sweep(Recorder):
    """``kit sweep``: the results of its trainings."""

    @property
    def words(self) -> Sequence[str]:
        short = ("--steps", "2000", "--episodes", "5", "--seeds", "200", "--jobs", "1", "--name", "kept")
        return ("-m", "kit", "sweep", "turn", "--algos", "q-learning", *short)

    def has_something(self) -> bool:
        return self.kept() > 1

    def kept(self) -> int:
        """Results that can be read."""
        folder = self.folder / "sweeps" / "kept"
        if not (folder / "manifest.json").exists():
            return 0
        sweep = TrainingSweep(folder)
        keys = sweep.keys()
        return sum(sweep.result(key) is not None for key in keys)


class Study(Recorder):
    """``kit study --again``: the log of its trainings."""

    @property
    def words(self) -> Sequence[str]:
        return ("-m", "kit", "study", "3.3", "--again", "--steps", "300", "--seeds", "100", "--jobs", "1")

    def has_something(self) -> bool:
        return self.kept() > 0

    def kept(self) -> int:
        """Tests of trained agents."""
        found = read_recorded_result(self.folder / "study" / "3.3.jsonl")
        return 0 if found is None else len(found.tests)


class LeagueMatches(Recorder):
    """``kit league run``: the matches that were driven."""

    ENTRIES: ClassVar[int] = 8

    def prepare(self) -> None:
        for number in range(self.ENTRIES):
            file = self.place.folder / f"entry{number}.py"
            file.write_text(FORWARD.replace("SPEED = 0.3", f"SPEED = {0.1 + 0.05 * number:.2f}"))
            words = ("-m", "kit", "league", "submit", "--controller", str(file))
            assert self.place.start(*words, output=self.place.folder / "entered.txt").wait() == 0

    @property
    def words(self) -> Sequence[str]:
        return ("-m", "kit", "league", "run", "--jobs", "1", "--level", "0")

    def has_something(self) -> bool:
        return self.kept() > 1

    def kept(self) -> int:
        """Results that can be read."""
        files = self.folder.glob("league/results/*.npz")
        return sum(bool(read_shared_drives(file.read_bytes()).recordings) for file in files)


class MapDrawing(Recorder):
    """``kit maps new`` on the screen: the drawing."""

    needs_terminal = True

    @property
    def _map(self) -> Path:
        return self.folder / "worlds" / "hall"

    @property
    def words(self) -> Sequence[str]:
        return ("-m", "kit", "maps", "new", "hall")

    def type_into(self, terminal: Terminal) -> None:
        for _ in range(400):
            terminal.write(b" \x1b[C")
            time.sleep(0.1)

    def has_something(self) -> bool:
        part = part_path(self._map)
        return part.exists() and part.read_bytes().count(b"\n") > 3

    def kept(self) -> int:
        """Squares of walls inside the sheet."""
        draft = SketchDraft(self._map)
        try:
            rows = () if draft.found is None else draft.found.rows[1:-1]
            return sum(row[1:-1].count("#") for row in rows)
        finally:
            draft.close(keeps=True)


class Editing(Recorder):
    """The editor of ``kit drive``: what was typed and not saved."""

    needs_terminal = True

    def prepare(self) -> None:
        (self.folder / "controllers").mkdir(exist_ok=True)
        self._program = self.folder / "controllers" / "mine.py"
        self._program.write_text(FORWARD)

    @property
    def words(self) -> Sequence[str]:
        return ("-m", "kit", "drive", "simple", "--controller", "mine")

    def type_into(self, terminal: Terminal) -> None:
        wait_until(lambda: b"bumps" in terminal.shown, "the robot on the screen")
        terminal.write(b"\x05")
        wait_until(lambda: b"SPEED" in terminal.shown, "the program in the editor")
        for _ in range(400):
            terminal.write(b"#")
            time.sleep(0.1)

    def has_something(self) -> bool:
        return self.kept() > 0

    def kept(self) -> int:
        """Characters that were typed."""
        draft = self._program.with_name(f".{self._program.name}{DRAFT_SUFFIX}")
        return len(draft.read_text()) - len(FORWARD) if draft.exists() else 0


RECORDERS: Final[Mapping[str, Callable[[Place], Recorder]]] = MappingProxyType(
    {
        "run --record": RunRecording,
        "play --record": PlayRecording,
        "run --bag": RunBag,
        "run --bag sqlite3": RunSqliteBag,
        "ros bag record": RosBag,
        "train": Training,
        "quiz": Quiz,
        "grader cohort": Cohort,
        "sweep": Sweep,
        "study": Study,
        "league run": LeagueMatches,
        "maps new": MapDrawing,
        "edit": Editing,
    }
)


class Started:
    """A recorder's program at a terminal, or with its output in a file."""

    def __init__(self, recorder: Recorder, *, output: Path | None = None) -> None:
        self.own, theirs = pty.openpty()
        environment = {**recorder.place.environment, "TERM": "xterm-256color"}
        self.log = recorder.place.folder / "output.txt"
        self._own_lock = threading.Lock()
        self._is_open = True
        self.shown = bytearray()
        self.log.touch()
        with (output or self.log).open("ab") as out, self.log.open("ab") as log:
            # both streams at the end of the file: neither over the other
            streams = theirs if recorder.needs_terminal and output is None else out
            self.process = subprocess.Popen(
                [sys.executable, "-P", *recorder.words],
                stdin=theirs,
                stdout=streams,
                stderr=theirs if streams == theirs else log,
                env=environment,
                cwd=recorder.place.folder,
                start_new_session=True,
            )
        os.close(theirs)
        self._typing = threading.Thread(target=self._type, args=(recorder,), daemon=True)
        self._reading = threading.Thread(target=self._read, daemon=True)
        self._typing.start()
        self._reading.start()

    def _type(self, recorder: Recorder) -> None:
        with suppress(OSError, AssertionError):
            recorder.type_into(self)

    def write(self, typed: bytes) -> None:
        """Types. Raises OSError once the terminal is closed."""
        with self._own_lock:
            if not self._is_open:  # its number may be that of another terminal by now
                raise OSError("the terminal is closed")
            os.write(self.own, typed)

    def _read(self) -> None:
        with suppress(OSError), self.log.open("ab") as log:
            while data := os.read(self.own, 65536):
                log.write(data)
                log.flush()
                self.shown += data

    @property
    def has_ended(self) -> bool:
        return self.process.poll() is not None

    @property
    def computed_s(self) -> float:
        """Processor time that the program and those of its processes that have ended took [s]; 0 where it has ended."""
        try:
            fields = Path(f"/proc/{self.process.pid}/stat").read_bytes().rpartition(b")")[2].split()
        except OSError:
            return 0.0
        return sum(map(int, fields[11:15])) / os.sysconf("SC_CLK_TCK")

    def hang_up(self) -> None:
        """Closes the terminal, as a dropped line does."""
        with self._own_lock:
            if self._is_open:
                self._is_open = False
                os.close(self.own)


def left_parts(folder: Path) -> list[str]:
    """Names of parts that nobody has restored."""
    return [part.name for part in parts_in(folder)]
