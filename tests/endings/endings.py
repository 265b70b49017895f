"""Ways in which a program ends, and what is kept of what it recorded: each is tried on each recorder."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import Final

from tests.endings.recorders import RECORDERS, Recorder, Started
from tests.kills.scenarios import Place
from tests.waiting import wait_until

END_S: Final = 180.0
"""How long a program may take to end [s]."""
READ_ONLY_S: Final = 4.0
"""After how much processor time a program that cannot write is asked to end [s]."""
READ_ONLY_WAIT_S: Final = 60.0
"""After how long at the latest [s]."""
SOMETHING_S: Final = 180.0
"""How long a program may take until there is something to keep [s]."""
NEED_MOUNT: Final = ("full disk", "read only")
"""The endings that need a file system of their own."""
DISK_KIB: Final = 4000
"""Size of the file system that becomes full [KiB]."""


@dataclass(frozen=True, slots=True)
class Ending:
    """What came of one ending of one recorder."""

    kept: int
    """How much of what was recorded is there; 0 means that it is lost."""
    exit_code: int
    text: str
    """The last line that the program printed."""
    has_traceback: bool = False
    had_something: bool = True
    """Whether there was anything to lose: a program that cannot print a word may end before."""

    @property
    def is_right(self) -> bool:
        return not self.has_traceback and (self.kept > 0 or not self.had_something)


def _until_something(recorder: Recorder, started: Started) -> float:
    """Waits until there is something to keep. Returns how much the program computed for it [s of processor time]."""
    wait_until(recorder.has_something, "something to keep", limit_s=SOMETHING_S)
    return started.computed_s


def _let_compute(started: Started, seconds: float) -> None:
    """Waits until a program has ended or has computed for so long, however busy the machine is."""
    until = started.computed_s + seconds
    wait_until(
        lambda: started.has_ended or started.computed_s >= until, "a program to compute", limit_s=SOMETHING_S
    )


def _by_signal(number: signal.Signals, recorder: Recorder, folder: Path) -> Ending:
    started = Started(recorder)
    _until_something(recorder, started)
    started.process.send_signal(number)
    return _end(recorder, started, outlives=recorder.outlives_terminal and number == signal.SIGHUP)


def _by_hang_up(recorder: Recorder, folder: Path) -> Ending:
    started = Started(recorder)
    _until_something(recorder, started)
    started.hang_up()
    started.process.send_signal(signal.SIGHUP)
    return _end(recorder, started, outlives=recorder.outlives_terminal)


def _by_kill_of_group(recorder: Recorder, folder: Path) -> Ending:
    started = Started(recorder)
    _until_something(recorder, started)
    os.killpg(started.process.pid, signal.SIGKILL)
    return _end(recorder, started)


def _by_partner(recorder: Recorder, folder: Path) -> Ending:
    """The world that is recorded is killed; elsewhere a process that the program has started, if there is one."""
    started = Started(recorder)
    taken_s = _until_something(recorder, started)
    if recorder.partner is not None:
        recorder.partner.kill()
    else:
        for child in _children(started.process.pid):
            with suppress(ProcessLookupError):
                os.kill(child, signal.SIGKILL)
        _let_compute(started, taken_s / 4)
        started.process.send_signal(signal.SIGINT)
    return _end(recorder, started)


def _by_second_writer(recorder: Recorder, folder: Path) -> Ending:
    """A second program of the same kind writes the same name: it is refused, and the first one loses nothing."""
    started = Started(recorder)
    taken_s = _until_something(recorder, started)
    second = Started(recorder)
    _let_compute(second, 2 * taken_s)
    second.process.send_signal(signal.SIGTERM)
    second.process.wait(END_S)
    started.process.send_signal(signal.SIGTERM)
    return _end(recorder, started)


def _by_full_disk(recorder: Recorder, folder: Path) -> Ending:
    """The folder in which it writes is a file system of its own that becomes full; where there is none, another's quota."""
    started = Started(recorder)
    taken_s = _until_something(recorder, started)
    filler = recorder.folder / "filler"
    with suppress(OSError), filler.open("wb", buffering=0) as file:
        while True:
            file.write(bytes(512))
    _let_compute(started, taken_s)
    started.process.send_signal(signal.SIGTERM)
    started.process.wait(END_S)
    filler.unlink(missing_ok=True)
    return _end(recorder, started)


def _by_read_only_folder(recorder: Recorder, folder: Path) -> Ending:
    """The folder in which it writes may only be read, from its start; where there is none, another's quota."""
    subprocess.run(["mount", "-o", "remount,ro", str(recorder.place.workspace)], check=True)
    started = Started(recorder)
    with suppress(AssertionError):  # one that waits for what is typed computes nothing
        wait_until(
            lambda: started.has_ended or started.computed_s >= READ_ONLY_S, "it", limit_s=READ_ONLY_WAIT_S
        )
    started.process.send_signal(signal.SIGTERM)
    started.process.wait(END_S)
    subprocess.run(["mount", "-o", "remount,rw", str(recorder.place.workspace)], check=True)
    ending = _end(recorder, started)
    return replace(ending, had_something=ending.kept > 0 or not ending.text)


def _by_closed_pipe(recorder: Recorder, folder: Path) -> Ending:
    """Who reads its output goes away (``kit run | head``), and then the program is asked to end. Who needs a terminal writes
    there."""
    if recorder.needs_terminal:
        return _by_hang_up(recorder, folder)
    pipe = recorder.place.folder / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    try:
        started = Started(recorder, output=pipe)
        wait_until(lambda: recorder.has_something() or started.has_ended, "something", limit_s=SOMETHING_S)
    finally:
        os.close(reader)
    has_ended = started.has_ended and not recorder.has_something()
    started.process.send_signal(signal.SIGTERM)
    return replace(_end(recorder, started), had_something=not has_ended)


def _by_full_output(recorder: Recorder, folder: Path) -> Ending:
    """Standard output is a full device, and then the program is asked to end."""
    started = Started(recorder, output=Path("/dev/full"))
    wait_until(lambda: recorder.has_something() or started.has_ended, "something", limit_s=SOMETHING_S)
    has_ended = started.has_ended and not recorder.has_something()
    started.process.send_signal(signal.SIGTERM)
    return replace(_end(recorder, started), had_something=not has_ended)


ENDINGS: Final[Mapping[str, Callable[[Recorder, Path], Ending]]] = MappingProxyType(
    {
        "SIGINT": partial(_by_signal, signal.SIGINT),
        "SIGTERM": partial(_by_signal, signal.SIGTERM),
        "SIGHUP": partial(_by_signal, signal.SIGHUP),
        "SIGQUIT": partial(_by_signal, signal.SIGQUIT),
        "hang up": _by_hang_up,
        "SIGKILL": partial(_by_signal, signal.SIGKILL),
        "group": _by_kill_of_group,
        "partner": _by_partner,
        "second": _by_second_writer,
        "full disk": _by_full_disk,
        "full out": _by_full_output,
        "read only": _by_read_only_folder,
        "closed pipe": _by_closed_pipe,
    }
)


def try_ending(recorder_name: str, ending_name: str, folder: Path) -> Ending:
    """Runs a recorder in a new folder and ends it so."""
    place = Place(folder / f"{recorder_name}-{ending_name}".replace(" ", "_").replace("-", "_"))
    place.make()
    is_mounted = ending_name in NEED_MOUNT and _mount(place.workspace)
    recorder = RECORDERS[recorder_name](place)
    try:
        recorder.prepare()
        return ENDINGS[ending_name](recorder, folder)
    finally:
        recorder.close()
        if is_mounted:
            subprocess.run(["umount", "-l", str(place.workspace)], check=False)
        shutil.rmtree(place.folder, ignore_errors=True)


def can_mount() -> bool:
    """Whether a small file system can be made here: only the superuser may."""
    return os.geteuid() == 0 and shutil.which("mount") is not None


def _mount(folder: Path) -> bool:
    words = ["mount", "-t", "tmpfs", "-o", f"size={DISK_KIB}k", "tmpfs", str(folder)]
    return subprocess.run(words, check=False, capture_output=True).returncode == 0


def _end(recorder: Recorder, started: Started, *, outlives: bool = False) -> Ending:
    """Waits until the program has ended. ``outlives``: it goes on, which is seen by what it records, and is killed then."""
    before = recorder.kept() if outlives else 0
    try:
        wait_until(
            lambda: started.has_ended or (outlives and recorder.kept() > before + 1),
            "the end, or more that is recorded" if outlives else "the end",
            limit_s=END_S,
        )
    except AssertionError as error:
        started.process.kill()
        return Ending(0, started.process.wait(), str(error))
    finally:
        started.hang_up()
    if not started.has_ended:
        started.process.kill()
        return Ending(recorder.kept(), started.process.wait(), "went on")
    code = started.process.returncode
    text = started.log.read_text(errors="replace")
    lines = [line for line in text.replace("\r", "\n").split("\n") if line.strip()]
    return Ending(
        recorder.kept(),
        code,
        lines[-1][-160:] if lines else "",
        has_traceback="Traceback (most recent" in text,
    )


def _children(parent: int) -> list[int]:
    found = []
    for status in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):
            if int(status.read_bytes().rpartition(b")")[2].split()[1]) == parent:
                found.append(int(status.parent.name))
    return found
