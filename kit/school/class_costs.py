"""Measures what a student costs this machine: several drive on screens of their own at once, and one work is checked."""

from __future__ import annotations

import os
import pty
import select
import signal
import struct
import subprocess
import tempfile
import termios
import time
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, ExitStack, contextmanager, suppress
from fcntl import ioctl
from pathlib import Path
from typing import Final

from kit.host.python_command import python_command
from kit.school.capacity import MachineSize, UseCost

AT_ONCE: Final = 3
"""Students who drive while it is measured: what they have in common is counted once."""
SCREEN: Final = (35, 120)
"""Rows and columns."""
KEYS: Final = b"wadw"
KEY_INTERVAL_S: Final = 0.2
DRIVE_S: Final = 8.0
SETTLED_S: Final = 2.0
START_LIMIT_S: Final = 120.0
CHECK_LIMIT_S: Final = 300.0
FIRST_PICTURE: Final = 4000
"""Bytes that a screen has written when its first picture is there."""
SAMPLE_S: Final = 0.05
_CLOCK_TICKS: Final = os.sysconf("SC_CLK_TCK") if hasattr(os, "sysconf") else 100


class NotMeasured(Exception):
    """It cannot be measured here; the message says why."""


def this_machine() -> MachineSize:
    """Its cores that this process may use, and the memory that is available. Raises NotMeasured."""
    try:
        fields = dict(line.split(":") for line in Path("/proc/meminfo").read_text().splitlines())
    except OSError:
        raise NotMeasured("only Linux says what programs use (/proc)") from None
    return MachineSize(len(os.sched_getaffinity(0)), 1024.0 * int(fields["MemAvailable"].split()[0]))


def measure_costs() -> UseCost:
    """Measures for about half a minute on a quiet machine. Raises NotMeasured."""
    this_machine()
    with tempfile.TemporaryDirectory(prefix="kit-class-") as folder:
        cores, memory = _measure_drives(Path(folder))
        core_s, wall_s, check_memory = _measure_check(Path(folder))
    return UseCost(cores, memory, core_s, wall_s, check_memory)


def _measure_drives(folder: Path) -> tuple[float, float]:
    """Cores and memory [bytes] of one drive of several."""
    with ExitStack() as stack:
        screens = [stack.enter_context(_drive(folder / f"student-{i}")) for i in range(AT_ONCE)]
        terminals = [terminal for _, terminal in screens]
        written = dict.fromkeys(terminals, 0)
        wait_for_picture(written, [process for process, _ in screens])
        press_keys(written, SETTLED_S)
        sessions = {process.pid for process, _ in screens}
        before, began = sum(map(_processor_s, _processes_of(sessions))), time.monotonic()
        press_keys(written, DRIVE_S)
        processes = _processes_of(sessions)
        used, took = sum(map(_processor_s, processes)) - before, time.monotonic() - began
        return used / took / AT_ONCE, sum(map(_memory, processes)) / AT_ONCE


def _drive(workspace: Path) -> AbstractContextManager[tuple[subprocess.Popen[bytes], int]]:
    return in_terminal(python_command("kit", "drive", "maze", "--workspace", str(workspace)))


@contextmanager
def in_terminal(command: list[str]) -> Iterator[tuple[subprocess.Popen[bytes], int]]:
    """Runs a command in a terminal of its own: its process, and the terminal's other end. Both end with the context."""
    ours, theirs = pty.openpty()
    ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", *SCREEN, 0, 0))
    environment = {**os.environ, "TERM": "xterm-256color", "COLORTERM": "truecolor"}
    process = subprocess.Popen(
        command, stdin=theirs, stdout=theirs, stderr=theirs, env=environment, start_new_session=True
    )
    os.close(theirs)
    try:
        yield process, ours
    finally:
        process.send_signal(signal.SIGTERM)
        with suppress(subprocess.TimeoutExpired):
            process.wait(5)
        for each in _processes_of({process.pid}):
            with suppress(OSError):
                os.kill(each, signal.SIGKILL)
        process.wait()
        os.close(ours)


def wait_for_picture(written: dict[int, int], processes: Sequence[subprocess.Popen[bytes]]) -> None:
    """Waits until every terminal shows a picture. Raises NotMeasured if one does not.

    ``written``: by terminal, the bytes that it has written.
    """
    deadline = time.monotonic() + START_LIMIT_S
    while min(written.values()) < FIRST_PICTURE:
        if time.monotonic() > deadline or any(each.poll() is not None for each in processes):
            raise NotMeasured("`kit drive maze` does not start here: try it")
        _measure_reading(written, KEY_INTERVAL_S)


def press_keys(written: dict[int, int], seconds: float) -> None:
    """Presses keys in every terminal, one after the other, and reads what they show."""
    for number in range(round(seconds / KEY_INTERVAL_S)):
        key = KEYS[number % len(KEYS) :][:1]
        for terminal in written:
            with suppress(OSError):
                os.write(terminal, key)
        _measure_reading(written, KEY_INTERVAL_S)


def _measure_reading(written: dict[int, int], seconds: float) -> None:
    until = time.monotonic() + seconds
    while (left := until - time.monotonic()) > 0:
        for terminal in select.select(list(written), [], [], left)[0]:
            with suppress(OSError):  # its program has ended
                written[terminal] += len(os.read(terminal, 1 << 16))


def _measure_check(folder: Path) -> tuple[float, float, float]:
    """Seconds of one core, wall clock [s] and most memory [bytes] of a check of a whole work: the example's solution."""
    example = folder / "example"
    made = subprocess.run(python_command("grader", "new", str(example)), capture_output=True, check=False)
    if made.returncode:
        raise NotMeasured("`grader new` fails here: try it")
    command = python_command("grader", "check", str(example / "solution.py"), "--assignment", str(example))
    before, began = _children_s(), time.monotonic()
    process = subprocess.Popen(
        command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True
    )
    most = 0.0
    while process.poll() is None:
        # The programs that are graded have sessions of their own.
        most = max(most, sum(map(_memory, _family_of(process.pid))))
        if time.monotonic() - began > CHECK_LIMIT_S:
            os.killpg(process.pid, signal.SIGKILL)
        time.sleep(SAMPLE_S)
    if process.returncode:
        raise NotMeasured("`grader check` of its own example fails here: try it")
    return _children_s() - before, time.monotonic() - began, most


def _children_s() -> float:
    used = os.times()
    return used.children_user + used.children_system


def _processes_of(sessions: set[int]) -> list[int]:
    """The processes of sessions, and of the programs that these have started in sessions of their own."""
    return [
        each
        for each, (parents, session) in _all_processes().items()
        if session in sessions or parents & sessions
    ]


def _family_of(process: int) -> list[int]:
    return [each for each, (parents, _) in _all_processes().items() if process in parents or each == process]


def _all_processes() -> dict[int, tuple[set[int], int]]:
    """The ancestors and the session of every process, by its number."""
    found = {}
    for name in (each.name for each in Path("/proc").iterdir() if each.name.isdigit()):
        with suppress(OSError):
            fields = Path(f"/proc/{name}/stat").read_text().rpartition(")")[2].split()
            found[int(name)] = int(fields[1]), int(fields[3])
    families: dict[int, tuple[set[int], int]] = {}
    for process, (parent, session) in found.items():
        above: set[int] = set()
        while parent in found and parent not in above:
            above.add(parent)
            parent = found[parent][0]
        families[process] = above, session
    return families


def _processor_s(process: int) -> float:
    """Seconds that a process has computed, with those of its children that have ended."""
    try:
        fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return sum(map(int, fields[11:15])) / _CLOCK_TICKS


def _memory(process: int) -> float:
    """The memory of a process, with its share of what it has in common with others [bytes]; all of that where its share is not
    told, since it holds secrets; 0 once it has ended."""
    folder = Path(f"/proc/{process}")
    with suppress(OSError):
        lines = (folder / "smaps_rollup").read_text().splitlines()
        return 1024.0 * sum(int(line.split()[1]) for line in lines if line.startswith("Pss:"))
    with suppress(OSError):
        return float(os.sysconf("SC_PAGE_SIZE") * int((folder / "statm").read_text().split()[1]))
    return 0.0
