"""Programs to be killed: drives, trainings, quizzes, cohorts and checks, each with what it has confirmed.

A scenario starts its program in a place of its own again and again, and goes on with what the killed one has left.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Final, Protocol

from kit.host.private_folder import PREFIX
from kit.inspection.sockets import SUFFIX, UNREADY_SUFFIX
from kit.learning.policies.policy import PolicyError
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.events import TrainingEvent, TrainingStarted
from kit.learning.training.run_config import RunConfig, RunError
from kit.learning.training.run_folders import create_run
from kit.learning.training.runs import TrainingRun
from kit.run.recording import RecordingError, load_recording
from kit.run.recording_file import restore_recordings
from kit.school.progress import EventKind, ProgressJournal
from tests.grader.conftest import FORWARD, write_assignment

ROOT: Final = Path(__file__).parents[2]
NEXT_START: Final = "from kit.host.private_folder import private_folder\nwith private_folder():\n    pass\n"


CLASS_SIZE: Final = 12
QUESTIONS: Final = 12
"""Of one round of the quiz."""
TYPING_S: Final = 0.06
"""Pause before each line that is typed [s]."""


@dataclass(frozen=True, slots=True)
class Place:
    """Where a scenario's programs run: their workspace, their home, their folder for temporary files."""

    folder: Path

    @property
    def workspace(self) -> Path:
        return self.folder / "workspace"

    @property
    def temporary(self) -> Path:
        return self.folder / "temporary"

    def make(self) -> None:
        """Makes the folders."""
        for path in (self.workspace, self.temporary):
            path.mkdir(parents=True)

    def start(
        self, *arguments: str, output: Path | None = None, lines: Sequence[str] = ()
    ) -> subprocess.Popen[bytes]:
        """Starts a Python program here, in a session of its own; these lines are typed one after the other."""
        with (output or self.folder / "output.txt").open("wb") as out:
            program = subprocess.Popen(
                [sys.executable, "-P", *arguments],
                stdin=subprocess.PIPE,
                stdout=out,
                stderr=subprocess.STDOUT,
                env=self.environment,
                start_new_session=True,
            )
        threading.Thread(target=_type_lines, args=(program, lines), daemon=True).start()
        return program

    @property
    def environment(self) -> Mapping[str, str]:
        """The whole environment, with caches where they always are: compiled kernels are not confirmed by anybody."""
        own = {
            "KIT_WORKSPACE": str(self.workspace),
            "TMPDIR": str(self.temporary),
            "HOME": str(self.folder),
            "PYTHONPATH": str(ROOT),
            "LANG": "C.UTF-8",
        }
        kept = {
            name: os.environ[name]
            for name in ("PATH", "XDG_CACHE_HOME", "LD_LIBRARY_PATH")
            if name in os.environ
        }
        return {"XDG_CACHE_HOME": str(Path.home() / ".cache")} | kept | own

    def leftovers(self) -> Iterator[str]:
        """Yields sockets and folders that no living program uses."""
        for path in sorted(self.temporary.iterdir()):
            yield f"{'a private folder' if path.name.startswith(PREFIX) else 'a temporary file'} is left: {path.name}"
        for path in self.workspace.rglob("*"):
            if path.name.endswith((SUFFIX, UNREADY_SUFFIX)):
                yield f"a socket is left: {path.name}"


class KillScenario(Protocol):
    """A program to be killed, over and over."""

    longest_s: float
    """It is killed at most so long after its start, as long as it takes on an idle machine [s]."""

    def start(self) -> subprocess.Popen[bytes]:
        """Starts the program, or goes on where the last one was killed."""

    def note_confirmed(self) -> None:
        """Remembers what the program has confirmed so far; called while it runs."""

    def start_next(self) -> Iterator[str]:
        """Makes the next start after a kill, and yields what is not as it should be."""

    def problems(self) -> Iterator[str]:
        """Yields what was confirmed and is lost; called after the next start."""


class DriveScenario:
    """``kit run`` with a controller, visible to other terminals, recording into a file."""

    longest_s = 3.5

    def __init__(self, place: Place) -> None:
        self._place = place
        self._file = place.folder / "drive.npz"
        self._seed = 0

    def start(self) -> subprocess.Popen[bytes]:
        self._seed += 1
        words = ("--controller", "avoid", "--steps", "300", "--speed", "3", "--seed", str(self._seed))
        return self._place.start("-m", "kit", "run", "maze", "--serve", "--record", str(self._file), *words)

    def note_confirmed(self) -> None:
        """Nothing is confirmed before the end, but a recording that is there is whole."""

    def start_next(self) -> Iterator[str]:
        yield from _run_to_end(self._place, "-m", "kit", "run", "maze", "--serve", "--steps", "1")

    def problems(self) -> Iterator[str]:
        list(restore_recordings(self._place.folder))  # as the next program does that records there
        with suppress(FileNotFoundError):
            try:
                load_recording(self._file)
            except RecordingError as error:
                yield f"a recording that is not whole: {error}"
        left = [path.name for path in self._place.folder.glob(f".{self._file.name}.*")]
        if left:
            yield f"a half-written file is left: {left[0]}"


class TrainingScenario:
    """The process that ``kit train`` starts, going on from its last checkpoint each time."""

    longest_s = 3.0

    def __init__(self, place: Place) -> None:
        config = RunConfig(TaskSpec("turn"), "q-learning", steps=10**9, keep_training=True)
        self._place = place
        (place.workspace / "runs").mkdir()
        self._run: TrainingRun = create_run(place.workspace / "runs", config, "killed")
        self._events: tuple[TrainingEvent, ...] = ()
        self._had_policy = False
        self._steps = 0

    def start(self) -> subprocess.Popen[bytes]:
        return self._place.start("-m", "kit.learning.training.worker", str(self._run.folder))

    def note_confirmed(self) -> None:
        self._events = self._run.events()
        self._had_policy = self._had_policy or self._run.newest_policy.exists()
        with suppress(RunError, OSError):
            loaded = self._run.load_checkpoint()
            if loaded is not None:
                self._steps = max(self._steps, int(json.loads(loaded[0]["learner.json"])["steps"]))

    def start_next(self) -> Iterator[str]:
        """The next training goes on from the checkpoint; it is stopped as soon as it has begun."""
        began = len([event for event in self._run.events() if isinstance(event, TrainingStarted)])
        program = self.start()
        try:
            while program.poll() is None:
                started = [event for event in self._run.events() if isinstance(event, TrainingStarted)]
                if len(started) > began:
                    if started[-1].steps < self._steps:
                        yield f"training goes on from step {started[-1].steps}; {self._steps} were in a checkpoint"
                    self._run.send_command("stop")
                    break
            if program.wait(120) != 0:
                yield f"the next training failed: {_last_line(self._place.folder / 'output.txt')}"
        finally:
            program.kill()
            program.wait()
        self._run.send_command("go")

    def problems(self) -> Iterator[str]:
        if self._run.events()[: len(self._events)] != self._events:
            yield "events are lost"
        if self._had_policy:
            try:
                self._run.policy(newest=True)
            except (PolicyError, RunError) as error:
                yield f"the policy is lost: {error}"


class QuizScenario:
    """``kit quiz``, answered line by line: each question shown confirms the answer before it."""

    longest_s = 0.8 + 2 * QUESTIONS * TYPING_S

    def __init__(self, place: Place) -> None:
        self._place = place
        self._output = place.folder / "quiz.txt"
        self._confirmed = 0

    def start(self) -> subprocess.Popen[bytes]:
        self._kept_before = self._kept()
        self._confirmed = 0
        words = ("-m", "kit", "quiz", "--plain", "--again")
        return self._place.start(*words, output=self._output, lines=["1", "3"] * QUESTIONS)

    def note_confirmed(self) -> None:
        text = self._output.read_text(errors="replace")
        shown = [int(number) for number in re.findall(r"^Question (\d+) of", text, re.MULTILINE)]
        if shown:  # the first number is above 1 where a round that was killed goes on
            self._confirmed = max(self._confirmed, shown[-1] - shown[0])

    def start_next(self) -> Iterator[str]:
        yield from _run_to_end(self._place, "-c", NEXT_START)

    def problems(self) -> Iterator[str]:
        kept = self._kept() - self._kept_before
        if kept < self._confirmed:
            yield f"{self._confirmed} answers were confirmed, {kept} are kept"

    def _kept(self) -> int:
        with ProgressJournal(self._place.workspace) as journal:
            if journal.notice:
                raise AssertionError(journal.notice)
            return sum(event.kind is EventKind.ANSWER for event in journal.events())


class CohortScenario:
    """``grader cohort``: a result that lies in the queue is confirmed, and the gradebook is that of an undisturbed run."""

    longest_s = 4.0

    def __init__(self, place: Place) -> None:
        self._place = place
        self._submissions = place.folder / "in"
        self._submissions.mkdir()
        for number in range(CLASS_SIZE):
            source = FORWARD.replace("SPEED = 0.3", f"SPEED = {0.05 + 0.03 * number:.2f}")
            (self._submissions / f"s{number}.py").write_text(source)
        (self._submissions / "broken.py").write_text("1/0\n")
        self._assignment = write_assignment(place.folder / "assignment")
        self._queue = place.folder / "queue"
        self._results: dict[str, bytes] = {}
        self._undisturbed = b""

    def start(self) -> subprocess.Popen[bytes]:
        if not self._undisturbed:
            assert self._grade().wait(600) == 0
            self._undisturbed = self._gradebook.read_bytes()
            shutil.rmtree(self._queue)
        return self._grade()

    def note_confirmed(self) -> None:
        for file in self._queue.glob("results/*.json"):
            self._results.setdefault(file.name, file.read_bytes())

    def start_next(self) -> Iterator[str]:
        yield from _run_to_end(self._place, "-c", NEXT_START)

    def problems(self) -> Iterator[str]:
        for name, content in self._results.items():
            file = self._queue / "results" / name
            if not file.exists() or file.read_bytes() != content:
                yield f"a result is lost or changed: {name}"
        if len(self._results) < CLASS_SIZE + 1:
            return
        if self._grade().wait(600) != 0 or self._gradebook.read_bytes() != self._undisturbed:
            yield "the gradebook is not that of an undisturbed run"
        shutil.rmtree(self._queue)
        self._results = {}

    @property
    def _gradebook(self) -> Path:
        return self._queue / "gradebook.json"

    def _grade(self) -> subprocess.Popen[bytes]:
        folders = ("--assignment", str(self._assignment), "--queue", str(self._queue))
        words = ("cohort", str(self._submissions), "--jobs", "2", "--level", "0", *folders)
        return self._place.start("-m", "grader", *words)


class CheckScenario:
    """``grader check`` of a student's own work: it confirms nothing, and leaves nothing."""

    longest_s = 2.5

    def __init__(self, place: Place) -> None:
        self._place = place
        self._work = place.folder / "controller.py"
        self._work.write_text(FORWARD)
        self._assignment = write_assignment(place.folder / "assignment")

    def start(self) -> subprocess.Popen[bytes]:
        return self._place.start(
            "-m", "grader", "check", str(self._work), "--assignment", str(self._assignment)
        )

    def note_confirmed(self) -> None:
        """There is nothing."""

    def start_next(self) -> Iterator[str]:
        yield from _run_to_end(self._place, "-c", NEXT_START)

    def problems(self) -> Iterator[str]:
        if self._work.read_text() != FORWARD:
            yield "the student's work has changed"


SCENARIOS: Final[Mapping[str, Callable[[Place], KillScenario]]] = MappingProxyType(
    {
        "drives": DriveScenario,
        "trainings": TrainingScenario,
        "quizzes": QuizScenario,
        "cohorts": CohortScenario,
        "checks": CheckScenario,
    }
)
"""By name; each is made with a place of its own."""


def _type_lines(program: subprocess.Popen[bytes], lines: Sequence[str]) -> None:
    assert program.stdin is not None
    with suppress(OSError), program.stdin:  # it has ended
        for line in lines:
            time.sleep(TYPING_S)
            program.stdin.write(line.encode() + b"\n")
            program.stdin.flush()


def _run_to_end(place: Place, *arguments: str) -> Iterator[str]:
    """Runs a program to its end; yields a sentence if it fails."""
    output = place.folder / "next.txt"
    code = place.start(*arguments, output=output).wait(120)
    if code != 0:
        yield f"the next start failed with exit code {code}: {_last_line(output)}"


def _last_line(file: Path) -> str:
    lines: Sequence[str] = file.read_text(errors="replace").strip().splitlines() or ("",)
    return lines[-1][:200]
