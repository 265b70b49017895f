"""Training runs on disk: a folder each, which the learner writes and everybody else reads.

``config.json`` what is learned and how; ``events.jsonl`` what happened; ``checkpoint.zip`` and ``checkpoint.old.zip``
from which training can go on; ``newest.npz`` and ``best.npz`` policies that need no torch; ``control`` what the learner
is asked to do; ``lock`` held by the learner while it lives; ``log.txt`` what it printed.
"""

from __future__ import annotations

import fcntl
import io
import json
import math
import os
import re
import time
import zipfile
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import IO, Any, Final, Literal, get_args

from kit.array_archives import READ_ERRORS, check_arrays, check_stored
from kit.field_types import check_field_types
from kit.learning.policies.policy import Policy
from kit.learning.policies.policy_file import load_policy
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.events import (
    Evaluated,
    EventReader,
    TrainingEnded,
    TrainingEvent,
    TrainingProgress,
    TrainingStarted,
)
from kit.plain_files import open_plain_file
from kit.plain_text import quoted, suggestion
from kit.workspace import write_atomically

RunCommand = Literal["go", "pause", "stop"]
"""Commands that a user interface may send to a learner."""
PresetName = Literal["kit", "seed", "seed-text"]
"""The kit's; the dissertation's as its code ran; the same as its text says (section 3.1.2)."""
NAME_PATTERN = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,99}")
LOCK_WAIT_S = 0.2
"""Seconds a learner waits for the lock, which a process that checks the run holds for a moment."""


def _try_lock(lock: IO[bytes]) -> bool:
    """Locks the file for this process alone; False if another one keeps it."""
    until = time.monotonic() + LOCK_WAIT_S
    while True:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            if time.monotonic() >= until:
                return False
            time.sleep(LOCK_WAIT_S / 20)
        else:
            return True


NO_LIMIT = "none"
"""Stands for an infinite limit."""


def format_settings(settings: Iterable[tuple[str, float]]) -> str:
    """Changed settings, as ``--set`` takes them: ``gamma=0.98 n_steps=64``."""
    return " ".join(f"{name}={format_setting(number)}" for name, number in settings)


def format_setting(number: float) -> str:
    """A setting's number, as ``--set`` takes it: infinity, of a limit, is ``none``."""
    return NO_LIMIT if math.isinf(number) else f"{number:.12g}"


class RunError(Exception):
    """A run is missing, damaged or busy, or cannot be written; the message says what to do."""


@dataclass(frozen=True, slots=True)
class RunConfig:
    """The task of a run and how it is learned."""

    choice: TaskSpec
    algorithm: str = "ppo"
    preset: PresetName = "kit"
    seed: int = 0
    steps: int | None = None
    """Instead of the preset's."""
    worlds: int | None = None
    learning_rate: float | None = None
    """Constant, instead of the preset's."""
    goal: float | None = None
    """Instead of the strategy's."""
    keep_training: bool = False
    """Use the dissertation's first strategy: to the last step, whatever tests say."""
    reward_file: str | None = None
    """A student's reward, instead of the task's."""
    mirrored: bool = False
    """Half of the worlds are seen in a mirror: what is learned on one side is known on the other."""
    imitate: tuple[str, ...] = ()
    """Files of demonstrators: recordings, policies, controllers."""
    settings: tuple[tuple[str, float], ...] = ()
    """Names and numbers of settings, instead of the preset's; see ``kit.learning.training.presets``."""

    @property
    def preset_text(self) -> str:
        """The preset and the settings that differ from it: ``preset kit, gamma=0.98``."""
        return f"preset {self.preset}" + (f", {format_settings(self.settings)}" if self.settings else "")

    @property
    def reward_name(self) -> str:
        """The reward that is not the task's own: a file's name, or the name of one of the kit's; else empty."""
        return Path(self.reward_file).name if self.reward_file is not None else self.choice.reward or ""

    def as_dict(self) -> dict[str, Any]:
        """JSON-able."""
        values = {name: getattr(self, name) for name in self.__dataclass_fields__ if name != "choice"}
        return {"choice": self.choice.as_dict(), **values, "settings": dict(self.settings)}

    @classmethod
    def from_dict(cls, data: Any) -> RunConfig:
        """Reads what ``as_dict`` returned. Raises ValueError for anything else."""
        try:
            plain = {name: value for name, value in data.items() if name not in ("choice", "settings")}
            settings = tuple((str(name), number) for name, number in data["settings"].items())
            check_field_types(cls, plain)
            if not all(type(number) in (int, float) for _, number in settings):
                raise ValueError("settings are numbers")
            choice = TaskSpec.from_dict(data["choice"])
            config = cls(choice, **{**plain, "imitate": tuple(data["imitate"])}, settings=settings)
        except (TypeError, KeyError, AttributeError) as error:
            raise ValueError(f"not the configuration of a run: {error}") from None
        if config.seed < 0 or any(count is not None and count < 1 for count in (config.steps, config.worlds)):
            raise ValueError(f"seed {config.seed}, {config.steps} steps, {config.worlds} worlds")
        return config


RunState = Literal["running", "paused", "finished", "stopped", "failed", "interrupted", "new"]


@dataclass(frozen=True, slots=True)
class TrainingSummary:
    """The state of a run and its last results."""

    state: RunState
    steps: int = 0
    seconds: float = 0.0
    rate: float = 0.0
    last_evaluation: Evaluated | None = None
    """The last test."""
    best_evaluation: Evaluated | None = None
    """That of the best policy."""
    reason: str = ""
    measures: dict[str, float] = field(default_factory=dict)
    """What the learner last measured of its own learning; see ``kit.learning.training.measures``."""

    def as_dict(self) -> dict[str, Any]:
        """JSON-able."""
        return asdict(self)


@dataclass(frozen=True, slots=True)
class TrainingRun:
    """One run's folder."""

    folder: Path

    @property
    def name(self) -> str:
        return self.folder.name

    @property
    def events_file(self) -> Path:
        return self.folder / "events.jsonl"

    @property
    def checkpoints(self) -> tuple[Path, Path]:
        """The newer one, the older one."""
        return self.folder / "checkpoint.zip", self.folder / "checkpoint.old.zip"

    @property
    def newest_policy(self) -> Path:
        return self.folder / "newest.npz"

    @property
    def best_policy(self) -> Path:
        return self.folder / "best.npz"

    @property
    def reward(self) -> Path:
        """The student's reward, if ``RunConfig.reward_file`` names one: as it was when the run began."""
        return self.folder / "reward.py"

    @property
    def task(self) -> Path:
        """The task's file as it was when the run began, if it is not one of the kit's tasks."""
        return self.folder / "task.yaml"

    def demonstrations(self) -> tuple[Path, ...]:
        """The files of ``RunConfig.imitate``: recordings and policies as they were when the run began."""
        kept = (self.folder / f"demonstration-{n}.npz" for n in range(len(self.config().imitate)))
        return tuple(
            file if file.exists() else Path(name)
            for file, name in zip(kept, self.config().imitate, strict=True)
        )

    @property
    def log(self) -> Path:
        return self.folder / "log.txt"

    @property
    def last_log_line(self) -> str:
        """The last line that the newest process printed: why it ended, where it could not write that among the events."""
        try:
            lines = self.log.read_text(errors="replace").split("\n")
        except FileNotFoundError:
            return ""
        return next((line.strip() for line in reversed(lines) if line.strip()), "")

    def config(self) -> RunConfig:
        """RunError if it is missing or damaged."""
        file = self.folder / "config.json"
        try:
            return RunConfig.from_dict(json.loads(file.read_bytes()))
        except FileNotFoundError:
            raise RunError(f"{self.folder}: not a run; its config.json is missing.") from None
        except (ValueError, OSError) as error:
            raise RunError(f"{file}: damaged ({error}). Start a new run with `kit train`.") from None

    def policy(self, *, newest: bool = False) -> Policy:
        """The best policy, or the newest one. PolicyError if it is damaged, RunError if there is none yet."""
        for file in (
            (self.newest_policy, self.best_policy) if newest else (self.best_policy, self.newest_policy)
        ):
            with suppress(FileNotFoundError):
                return load_policy(file)
        raise RunError(
            f"{self.name} has no policy yet, because nothing has been tested. Let it train a little longer."
        )

    # What the learner is asked to do

    def send_command(self, order: RunCommand) -> None:
        """Sends a command, which the learner follows between two updates."""
        write_atomically(self.folder / "control", order.encode())

    def read_command(self) -> RunCommand:
        """Returns the newest command."""
        with suppress(OSError, UnicodeDecodeError):
            text = (self.folder / "control").read_text().strip()
            return next((order for order in get_args(RunCommand) if order == text), "go")
        return "go"

    # Who is at it

    @contextmanager
    def lock(self) -> Iterator[None]:
        """Keeps others from training this run; the system lets go when the process ends, however it does.

        RunError if a process trains it already.
        """
        with (self.folder / "lock").open("ab") as lock:
            if not _try_lock(lock):
                raise RunError(f"{self.name} is already training. `kit watch {self.name}` shows it.")
            yield

    @property
    def is_active(self) -> bool:
        """Whether a process trains it."""
        try:
            with (self.folder / "lock").open("rb") as lock:
                fcntl.flock(lock, fcntl.LOCK_SH | fcntl.LOCK_NB)
                return False
        except FileNotFoundError:
            return False
        except OSError:
            return True

    # What has happened

    def events(self) -> tuple[TrainingEvent, ...]:
        return tuple(EventReader(self.events_file).read_new())

    def summary(self) -> TrainingSummary:
        """Returns its state and last results."""
        found = summarise_events(self.events(), alive=self.is_active, order=self.read_command())
        return replace(found, reason=self.last_log_line) if found.state == "interrupted" else found

    # Checkpoints

    def save_checkpoint(self, parts: Mapping[str, bytes]) -> None:
        """Writes the parts as one file; the one before stays as the older one. OSError if the disk is full."""
        buffer = io.BytesIO()
        with zipfile.ZipFile(buffer, "w") as archive:  # its checksums tell a damaged file
            for name, data in parts.items():
                archive.writestr(name, data)
        newer, older = self.checkpoints
        if newer.exists():
            newer.replace(older)
        write_atomically(newer, buffer.getvalue())

    def load_checkpoint(self) -> tuple[dict[str, bytes], str] | None:
        """The parts of the newest checkpoint that is whole, and what is wrong with a newer one; None if there is
        no checkpoint. RunError if all are damaged."""
        damage = ""
        for file in self.checkpoints:
            try:
                return _read_checkpoint(file), damage
            except FileNotFoundError:
                continue
            except READ_ERRORS as error:
                damage = f"{file.name} is damaged ({error})"
        if damage:
            raise RunError(
                f"{self.folder}: {damage}, and there is no other. The policies in it are intact; to train on, start a "
                "new run with `kit train`."
            )
        return None


MAX_CHECKPOINT_BYTES: Final = 4 << 30
"""Bytes of a checkpoint: its replay buffer is the largest part."""


def _read_checkpoint(file: Path) -> dict[str, bytes]:
    """Returns the parts of a checkpoint, which may be somebody else's: none of them unpacks to more than it is. Raises OSError,
    ValueError and zipfile.BadZipFile."""
    with open_plain_file(file) as opened:
        size = os.fstat(opened.fileno()).st_size
        if size > MAX_CHECKPOINT_BYTES:
            raise zipfile.BadZipFile(f"it is larger than {MAX_CHECKPOINT_BYTES >> 30} GiB")
        with zipfile.ZipFile(opened) as archive:
            check_stored(archive, size)
            parts = {name: archive.read(name) for name in archive.namelist()}
    for name, data in parts.items():
        if zipfile.is_zipfile(io.BytesIO(data)):  # arrays, or parameters of torch's
            with zipfile.ZipFile(io.BytesIO(data)) as inner:
                check_stored(inner, len(data))
                if name.endswith(".npz"):
                    check_arrays(inner, MAX_CHECKPOINT_BYTES)
    return parts


def summarise_events(events: tuple[TrainingEvent, ...], *, alive: bool, order: RunCommand) -> TrainingSummary:
    """Summarises a run's events."""
    steps, seconds, rate, reason = 0, 0.0, 0.0, ""
    tested: Evaluated | None = None
    best: Evaluated | None = None
    measures: dict[str, float] = {}
    state: RunState = "interrupted" if events else "new"
    for event in events:
        match event:
            case TrainingStarted():
                state, steps = "interrupted", event.steps
            case TrainingProgress():
                steps, seconds, rate = event.steps, event.seconds, event.rate
                measures = event.measures or measures
            case Evaluated():
                tested, measures = event, event.measures or measures
                best = event if event.kept else best
            case TrainingEnded():
                state, steps, seconds, reason = event.how, event.steps, event.seconds, event.reason
            case _:
                pass
    if alive:
        state = "paused" if order == "pause" else "running"
    return TrainingSummary(state, steps, seconds, rate, tested, best, reason, measures)


def create_run(folder: Path, config: RunConfig, name: str | None = None) -> TrainingRun:
    """Makes a run's folder in ``folder``; by default named after what it learns. RunError if that is taken.

    The run keeps its own copies of the task's and the reward's files.
    """
    config = replace(config, choice=config.choice.frozen())
    task = config.choice.resolve()
    if config.reward_file is None and task.reward_file is not None:
        config = replace(config, reward_file=str(task.reward_file.absolute()))
    if name is not None and not NAME_PATTERN.fullmatch(name):
        raise RunError(f"{quoted(name)}: a run's name may contain letters, digits, '_', '-' and '.'.")
    made = (
        _make_folder(folder, name) if name is not None else _make_unused_folder(folder, _default_name(config))
    )
    if config.reward_file is not None:  # the run keeps its own: the student goes on writing
        write_atomically(TrainingRun(made).reward, Path(config.reward_file).read_bytes())
    for number, name in enumerate(config.imitate):
        if name.endswith(".npz"):
            write_atomically(made / f"demonstration-{number}.npz", Path(name).read_bytes())
    if config.choice.text is not None:
        write_atomically(TrainingRun(made).task, config.choice.text.encode())
    write_atomically(made / "config.json", json.dumps(config.as_dict(), indent=1).encode())
    return TrainingRun(made)


def _default_name(config: RunConfig) -> str:
    parts = [config.choice.name, *config.choice.on, config.algorithm, config.preset]
    return "-".join([*parts, str(config.seed)])[:90]


def _make_folder(folder: Path, name: str) -> Path:
    try:
        (folder / name).mkdir()
    except FileExistsError:
        raise RunError(
            f"a run {name} already exists. Choose another name with --name, or resume it: "
            f"`kit train --resume {name}`."
        ) from None
    return folder / name


def _make_unused_folder(folder: Path, name: str) -> Path:
    """The first of name, name-2, name-3, ... that is free."""
    number = 1
    while True:
        try:
            return _make_folder(folder, name if number == 1 else f"{name}-{number}")
        except RunError:
            number += 1


def list_runs(folder: Path) -> tuple[TrainingRun, ...]:
    """Every run in the folder, the one begun last first."""
    files = [(file.stat().st_mtime, file.parent) for file in folder.glob("*/config.json")]
    return tuple(TrainingRun(each) for _, each in sorted(files, reverse=True))


def find_run(folder: Path, name: str | None = None) -> TrainingRun:
    """The run of that name, or, without one, the one begun last. RunError if there is none."""
    runs = {run.name: run for run in list_runs(folder)}
    if name is None:
        if not runs:
            raise RunError("There are no runs yet. `kit train turn` starts one.")
        return next(iter(runs.values()))
    if name in runs:
        return runs[name]
    if not runs:
        raise RunError(f"There is no run {quoted(name)}, nor any other. `kit train turn` starts one.")
    raise RunError(f"There is no run {quoted(name)}: {suggestion(name, runs)}")
