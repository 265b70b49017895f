"""Training runs on disk: a folder each, which the learner writes and everybody else reads.

``config.json`` what is learned and how; ``events.jsonl`` what happened; ``checkpoint.zip`` and ``checkpoint.old.zip``
from which training can go on; ``newest.npz`` and ``best.npz`` policies that need no torch; ``control`` what the learner
is asked to do; ``lock`` held by the learner while it lives; ``log.txt`` what it printed.
"""

from __future__ import annotations

import io
import json
import os
import zipfile
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, get_args

from kit.array_archives import READ_ERRORS
from kit.learning.policies.policy import Policy
from kit.learning.policies.policy_file import load_policy
from kit.learning.training.checkpoint_file import read_checkpoint
from kit.learning.training.events import (
    EventReader,
    TrainingEvent,
)
from kit.learning.training.process_lock import LockedError, is_locked, process_lock
from kit.learning.training.run_config import RunConfig, RunError
from kit.learning.training.training_summary import TrainingCommand, TrainingSummary, summarise_events
from kit.plain_files import open_plain_file, read_plain_file
from kit.plain_text import escape_controls
from kit.workspace import write_atomically

MAX_CONFIG_BYTES: Final = 16 << 20
"""Bytes of ``config.json``: it may hold a task's whole text."""
MAX_COMMAND_BYTES: Final = 100
"""Bytes of ``control``."""
LOG_END_BYTES: Final = 64 << 10
"""Bytes at the end of the log, in which its last line is."""
MAX_SHOWN: Final = 1000
"""Characters of that line which are shown."""


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
        """The last line that the newest process printed, or its beginning: why it ended, where it could not write that among the
        events."""
        try:
            with open_plain_file(self.log) as file:
                file.seek(max(0, file.seek(0, os.SEEK_END) - LOG_END_BYTES))
                lines = file.read(LOG_END_BYTES).decode(errors="replace").split("\n")
        except FileNotFoundError:
            return ""
        return escape_controls(next(filter(None, map(str.strip, reversed(lines))), "")[:MAX_SHOWN])

    def config(self) -> RunConfig:
        """RunError if it is missing or damaged."""
        file = self.folder / "config.json"
        try:
            return RunConfig.from_dict(json.loads(read_plain_file(file, MAX_CONFIG_BYTES)))
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

    def send_command(self, order: TrainingCommand) -> None:
        """Sends a command, which the learner follows between two updates."""
        write_atomically(self.folder / "control", order.encode())

    def read_command(self) -> TrainingCommand:
        """Returns the newest command."""
        with suppress(OSError, UnicodeDecodeError):
            text = read_plain_file(self.folder / "control", MAX_COMMAND_BYTES).decode().strip()
            return next((order for order in get_args(TrainingCommand) if order == text), "go")
        return "go"

    # Who is at it

    @contextmanager
    def lock(self) -> Iterator[None]:
        """Keeps others from training this run; the system lets go when the process ends, however it does.

        RunError if a process trains it already.
        """
        with ExitStack() as stack:
            try:
                stack.enter_context(process_lock(self._lock_file))
            except LockedError:
                raise RunError(
                    f"{self.name} is already training. `kit watch {self.name}` shows it."
                ) from None
            yield

    @property
    def is_active(self) -> bool:
        """Whether a process trains it."""
        return is_locked(self._lock_file)

    @property
    def _lock_file(self) -> Path:
        return self.folder / "lock"

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
                return read_checkpoint(file), damage
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
