"""Runs fuzz targets: each input in turn, in batches, each batch in a process of its own that is watched.

An input is made from the seed, the target's name and its number alone, so a finding can be tried again by these.
"""

from __future__ import annotations

import ctypes
import faulthandler
import gc
import json
import os
import random
import resource
import shutil
import signal
import sys
import tempfile
import threading
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from mmap import mmap
from pathlib import Path
from types import MappingProxyType
from typing import Final, Protocol

from kit.host.sandbox.reaper import descendants, end_descendants
from tests.fuzz.descriptions import (
    ClassListTarget,
    LaunchFileTarget,
    LessonTarget,
    PackageTarget,
    PictureTarget,
    RequirementsTarget,
    SharedDriveTarget,
)
from tests.fuzz.files import ArchiveTarget, RecordingTarget, RunTarget, SubmittedYamlTarget, WorldTarget
from tests.fuzz.frames import FrameTarget
from tests.fuzz.readers import (
    AssignmentTarget,
    BagTarget,
    ExportTarget,
    MessageTarget,
    PolicyTarget,
    ResultTarget,
    TaskTarget,
)

HANG_S: Final = 60.0
"""How long one input may take: a hundred times longer than on an idle machine [s]."""
PREPARE_S: Final = 600.0
"""How long the preparation of a target may take: kernels may have to be compiled first [s]."""
SLOW_S: Final = 10.0
"""Processor time that one input may take [s]."""
WARM_INPUTS: Final = 200
"""Inputs after which a process has loaded all that it will need; growth is counted from there."""
MAX_GROWTH: Final = 64 << 20
"""Bytes by which a process may have grown at the end of a batch."""
MAX_PEAK: Final = 600 << 20
"""Bytes that one input may need for a moment beyond what the process had when warm."""
NOT_BEGUN: Final = b"\xff" * 8
"""In place of the number of an input, while there was none."""


class FuzzTarget(Protocol):
    """Something that reads what others write."""

    def attempt(self, rng: random.Random) -> str:
        """Makes one input, has it read, and returns what became of it. Whatever it raises is a finding."""


TARGETS: Final[Mapping[str, Callable[[Path], FuzzTarget]]] = MappingProxyType(
    {
        "frames": FrameTarget,
        "archives": ArchiveTarget,
        "yaml": SubmittedYamlTarget,
        "recordings": RecordingTarget,
        "worlds": WorldTarget,
        "runs": RunTarget,
        "policies": PolicyTarget,
        "exports": ExportTarget,
        "tasks": TaskTarget,
        "assignments": AssignmentTarget,
        "results": ResultTarget,
        "messages": MessageTarget,
        "bags": BagTarget,
        "launches": LaunchFileTarget,
        "packages": PackageTarget,
        "lessons": LessonTarget,
        "classes": ClassListTarget,
        "layers": RequirementsTarget,
        "pictures": PictureTarget,
        "boards": SharedDriveTarget,
    }
)
"""By name; each is made with a folder for its files."""


@dataclass(frozen=True, slots=True)
class Finding:
    """An input that did what none may do: a traceback, a hang, a crash, or growth."""

    target: str
    number: int
    """The input's number; for growth, the last one of its batch."""
    problem: str

    def __str__(self) -> str:
        return f"{self.target}:{self.number}: {self.problem}"


@dataclass(slots=True)
class BatchReport:
    """What became of a batch of inputs."""

    outcomes: Counter[str] = field(default_factory=Counter)
    findings: list[Finding] = field(default_factory=list)
    done: int = 0
    """Inputs that were tried; fewer than asked for after a crash or a hang."""
    growth: int = 0
    """Bytes of memory by which the process grew once it was warm."""


def input_rng(seed: int, target: str, number: int) -> random.Random:
    """Returns the random generator that makes one input."""
    return random.Random(f"{seed}/{target}/{number}")


def run_batch(
    name: str,
    numbers: range,
    *,
    seed: int,
    targets: Mapping[str, Callable[[Path], FuzzTarget]] = TARGETS,
    hang_s: float = HANG_S,
) -> BatchReport:
    """Tries these inputs in a process of its own, and ends that if it hangs. RuntimeError if it cannot even begin."""
    folder = Path(tempfile.mkdtemp(prefix="kit-fuzz-"))
    answer, progress = folder / "answer.json", mmap(-1, 8)
    progress[:8] = NOT_BEGUN
    sys.stdout.flush()
    sys.stderr.flush()
    child = os.fork()
    if child == 0:
        _run_in_child(targets[name], folder, name, numbers, seed, progress, answer)
    try:
        status = _wait_or_kill(child, progress, hang_s)
        report = _read_report(name, answer) or BatchReport()
        if progress[:8] == NOT_BEGUN:
            raise RuntimeError(f"the target {name} could not be prepared: exit code {status}")
        at = int.from_bytes(progress[:8], "little")
        if status is None:
            report.findings.append(Finding(name, numbers[at], f"no answer within {hang_s:g} s"))
        elif status != 0:
            report.findings.append(Finding(name, numbers[at], f"the process ended with status {status}"))
        report.done = len(numbers) if status == 0 else at + 1
        return report
    finally:
        progress.close()
        shutil.rmtree(folder, ignore_errors=True)


def _wait_or_kill(child: int, progress: mmap, hang_s: float) -> int | None:
    """Returns a process's exit code; None if it made no progress and was killed."""
    last, since = b"", time.monotonic()
    while True:
        ended, status = os.waitpid(child, os.WNOHANG)
        if ended:
            return os.waitstatus_to_exitcode(status)
        if progress[:8] != last:
            last, since = progress[:8], time.monotonic()
        elif time.monotonic() - since > (PREPARE_S if last == NOT_BEGUN else hang_s):
            for each in (*descendants(child), child):
                with suppress(ProcessLookupError):
                    os.kill(each, signal.SIGKILL)
            os.waitpid(child, 0)
            return None
        time.sleep(0.02)


def _read_report(name: str, answer: Path) -> BatchReport | None:
    try:
        content = json.loads(answer.read_bytes())
    except OSError:  # it has crashed
        return None
    findings = [Finding(name, number, problem) for number, problem in content["findings"]]
    return BatchReport(Counter(content["outcomes"]), findings, 0, content["growth"])


def _run_in_child(
    make: Callable[[Path], FuzzTarget],
    folder: Path,
    name: str,
    numbers: range,
    seed: int,
    progress: mmap,
    answer: Path,
) -> None:
    """Runs in the process of a batch; does not return."""
    code = 1
    try:
        faulthandler.enable()
        warnings.simplefilter("error")  # a user would see one, and not know what to do
        temporary = folder / "temporary"
        temporary.mkdir()
        tempfile.tempdir = str(temporary)
        os.environ["TMPDIR"] = str(temporary)
        (folder / "files").mkdir()
        report = _try_all(make(folder / "files"), name, numbers, seed, progress)
        content = {
            "outcomes": report.outcomes,
            "findings": [(each.number, each.problem) for each in report.findings],
            "growth": report.growth,
        }
        answer.write_text(json.dumps(content))
        code = 0
    except BaseException:  # noqa: BLE001 - the process ends here, and says why
        traceback.print_exc()
    finally:
        end_descendants(os.getpid())
        os._exit(code)


def _try_all(target: FuzzTarget, name: str, numbers: range, seed: int, progress: mmap) -> BatchReport:
    report = BatchReport()
    warm = min(WARM_INPUTS, len(numbers) // 2)
    before, peak = _Resources.now(), 0
    for at, number in enumerate(numbers):
        progress[:8] = at.to_bytes(8, "little")
        if at == warm:
            before, peak = _Resources.now(), _peak_memory()
        began = time.process_time()
        try:
            report.outcomes[target.attempt(input_rng(seed, name, number))] += 1
        except Exception as error:  # noqa: BLE001 - every one is a finding
            report.findings.append(Finding(name, number, _short_traceback(error)))
        if (taken := time.process_time() - began) > SLOW_S:
            report.findings.append(Finding(name, number, f"{taken:.0f} s of processor time"))
        if at > warm and _peak_memory() - peak > MAX_PEAK:
            report.findings.append(Finding(name, number, f"{(_peak_memory() - peak) >> 20} MiB at once"))
            peak = _peak_memory()
    after = _Resources.now()
    report.growth = after.memory - before.memory
    report.findings += [Finding(name, numbers[-1], problem) for problem in after.problems_since(before)]
    return report


@dataclass(frozen=True, slots=True)
class _Resources:
    """What a process holds."""

    memory: int
    """Bytes."""
    descriptors: int
    threads: int
    temporary: frozenset[str]
    """Names of files and folders among the temporary ones."""
    processes: int

    @classmethod
    def now(cls) -> _Resources:
        gc.collect()
        with suppress(AttributeError):  # glibc keeps what was freed for later; musl does not
            ctypes.CDLL(None).malloc_trim(0)
        pages = int(Path("/proc/self/statm").read_text().split()[1])
        return cls(
            pages * os.sysconf("SC_PAGE_SIZE"),
            sum(1 for _ in Path("/proc/self/fd").iterdir()),
            threading.active_count(),
            frozenset(path.name for path in Path(tempfile.gettempdir()).iterdir()),
            len(descendants(os.getpid())),
        )

    def problems_since(self, before: _Resources) -> Iterator[str]:
        """Yields what has grown."""
        if self.memory - before.memory > MAX_GROWTH:
            yield f"memory grew by {(self.memory - before.memory) >> 20} MiB"
        if self.descriptors > before.descriptors:
            yield f"{self.descriptors - before.descriptors} descriptors left open"
        if self.threads > before.threads:
            yield f"{self.threads - before.threads} threads left"
        if self.processes > before.processes:
            yield f"{self.processes - before.processes} processes left"
        left = self.temporary - before.temporary
        if left:
            yield f"temporary files left: {', '.join(sorted(left)[:3])}"


def _peak_memory() -> int:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def _short_traceback(error: BaseException) -> str:
    """Returns an error and the lines that led to it, the innermost first, on one line."""
    cause = error.__cause__ or error
    places = traceback.extract_tb(cause.__traceback__)[::-1][:8]
    shown = " < ".join(f"{Path(place.filename).name}:{place.lineno}" for place in places)
    return f"{type(cause).__name__}: {str(cause)[:200]} ({shown})"
