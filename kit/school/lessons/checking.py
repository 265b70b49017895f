"""One check of an exercise: the grader in a process of its own, asked by its command, so that nothing slow or hostile
touches the face. The kit never imports the grader."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryFile
from types import TracebackType
from typing import Any, Final, Self

from kit.school.lessons.records import Exercise

LONGEST_S: Final = 300.0
"""A check that takes longer has hung, and is ended."""
HINT_STEPS: Final = 3


@dataclass(frozen=True, slots=True)
class Judged:
    """One criterion, judged."""

    id: str
    title: str
    status: str
    """``pass``, ``partial``, ``fail``, ... as the grader says."""
    points: float
    max_points: float
    said: str
    """What was wrong."""
    expected: str
    actual: str
    hints: tuple[str, ...]
    picture: str
    """What happened, in characters; may be empty."""
    log: str
    """What the program printed."""

    @property
    def passed(self) -> bool:
        return self.status == "pass"


@dataclass(frozen=True, slots=True)
class Report:
    """What came of one check."""

    verdict: str
    """``pass``, ``fail``, or ``broken``: the check itself failed, which is never the student's doing."""
    points: float
    max_points: float
    criteria: tuple[Judged, ...]
    submission: str
    """A digest of what was checked."""
    seconds: float
    problem: str = ""
    """Why there is no judgement: for a broken check, or a file that is missing."""
    replay: Path | None = None
    """The worst episode's recording, where there is one."""

    @property
    def passed(self) -> bool:
        return self.verdict == "pass"

    @property
    def lost(self) -> tuple[Judged, ...]:
        """The criteria that did not pass, in order."""
        return tuple(each for each in self.criteria if not each.passed)

    def as_event(self) -> Mapping[str, Any]:
        """What the journal keeps of it."""
        return {
            "points": self.points,
            "max_points": self.max_points,
            "verdict": self.verdict,
            "lost": [each.id for each in self.lost],
            "submission": self.submission,
            "seconds": round(self.seconds, 2),
        }


class Check:
    """A check that runs. ``poll`` it, or ``wait``; leaving the context ends it and everything it started."""

    def __init__(self, exercise: Exercise, file: Path, *, replay: Path | None = None) -> None:
        """``file``: what the student edits; where it came with others, their folder is handed in.
        ``replay``: where to keep the worst episode."""
        self._began = time.monotonic()
        self._replay = replay
        self._out = TemporaryFile()  # noqa: SIM115  # lives as long as the check, and `close` closes it
        self._said = TemporaryFile()  # noqa: SIM115  # lives as long as the check, and `close` closes it
        self._report: Report | None = None
        self._process: subprocess.Popen[bytes] | None = None
        if not file.exists():
            self._report = _without(f"{file} is not there. `x` lays the exercise out anew.", "fail")
            return
        if not file.is_file():
            self._report = _without(
                f"{file} is no file. Save your work under that name; `x` lays the exercise out anew and keeps what is there.",
                "fail",
            )
            return
        if replay is not None:
            replay.unlink(missing_ok=True)
        command = [sys.executable, "-m", "grader", "check", str(handed_in(exercise, file))]
        command += ["--assignment", str(exercise.folder), "--json", "--for-student", "--secret"]
        command += ["--replay", str(replay)] if replay is not None else []
        try:
            self._process = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=self._out,
                stderr=self._said,
                # From another folder than the student's: nothing that lies there is imported by our own process.
                cwd=exercise.folder,
                start_new_session=True,
            )
        except OSError as error:
            self._report = _without(f"The check could not be started ({error.strerror}).", "broken")

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @property
    def seconds(self) -> float:
        """How long it has been running."""
        return time.monotonic() - self._began

    def poll(self) -> Report | None:
        """What came of it; None while it runs."""
        if self._report is None and self._process is not None:
            if self._process.poll() is not None:
                self._report = self._read()
            elif self.seconds > LONGEST_S:
                self._kill()
                self._report = _without(
                    f"The check did not end within {LONGEST_S:g} s and was stopped.", "broken"
                )
        return self._report

    def wait(self) -> Report:
        """What came of it, however long it takes."""
        while (report := self.poll()) is None:
            assert self._process is not None
            with contextlib.suppress(subprocess.TimeoutExpired):
                self._process.wait(max(0.01, min(1.0, LONGEST_S - self.seconds)))
        return report

    def close(self) -> None:
        """Ends it. May be called twice."""
        self._kill()
        self._out.close()
        self._said.close()

    def _kill(self) -> None:
        if self._process is None or self._process.poll() is not None:
            return
        with contextlib.suppress(ProcessLookupError):
            # Asked first: the grader then ends the programs it has started.
            os.killpg(self._process.pid, signal.SIGTERM)
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(2.0)
        if self._process.poll() is None:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self._process.pid, signal.SIGKILL)
            self._process.wait()

    def _read(self) -> Report:
        self._out.seek(0)
        self._said.seek(0)
        said = self._said.read().decode(errors="replace").strip()
        try:
            content = json.loads(self._out.read())
            return _report(content, self.seconds, self._replay)
        except (ValueError, KeyError, TypeError):
            assert self._process is not None
            # 2: what was handed in cannot be taken, which the student can mend.
            verdict = "fail" if self._process.returncode == 2 else "broken"
            last = said.splitlines()[-1] if said else f"exit code {self._process.returncode}"
            return _without(said if verdict == "fail" else f"The check broke: {last}", verdict)


def check(exercise: Exercise, file: Path, *, replay: Path | None = None) -> Report:
    """Checks an exercise and waits for what comes of it."""
    with Check(exercise, file, replay=replay) as running:
        return running.wait()


def handed_in(exercise: Exercise, file: Path) -> Path:
    """The file, or the folder it came in where the starter is a folder."""
    return file.parent if (exercise.folder / "starter").is_dir() else file


def _without(problem: str, verdict: str) -> Report:
    return Report(verdict, 0.0, 0.0, (), "", 0.0, problem)


def _report(content: Mapping[str, Any], seconds: float, replay: Path | None) -> Report:
    return Report(
        verdict=str(content["verdict"]),
        points=float(content["points"] or 0.0),
        max_points=float(content["max_points"]),
        criteria=tuple(_judged(each) for each in content["tests"]),
        submission=str(content["submission"]),
        seconds=seconds,
        problem="The grader broke; that is not your fault." if content["verdict"] == "broken" else "",
        replay=replay if replay is not None and replay.is_file() else None,
    )


def _judged(content: Mapping[str, Any]) -> Judged:
    return Judged(
        id=str(content["id"]),
        title=str(content["title"]),
        status=str(content["status"]),
        points=float(content["points"]),
        max_points=float(content["max_points"]),
        said=str(content["rationale"]),
        expected=str(content["expected"]),
        actual=str(content["actual"]),
        hints=tuple(map(str, content["hints"]))[:HINT_STEPS],
        picture=str(content["replay"]),
        log=str(content["log"]),
    )
