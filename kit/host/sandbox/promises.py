"""Lists what each confinement level prevents a student's program from doing.

``kit doctor`` prints it, ``.github/SECURITY.md`` shows it, and ``tests/host/sandbox/test_promises.py`` tries each row.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from kit.host.sandbox.sandbox_config import Level


@dataclass(frozen=True, slots=True)
class Promise:
    """Something that a student's program cannot do from one level on."""

    key: str
    action: str
    """Completes the sentence "a student's program cannot ..."."""
    since: Level | None
    """The lowest level that prevents it (level 0: that no accident does it); None: no level does."""

    def holds_at(self, level: Level) -> bool:
        """Returns whether this level prevents the action."""
        return self.since is not None and level >= self.since


PROMISES: Final = (
    Promise("outlive", "run on after its run has ended or the kit was killed (Linux)", Level.LIMITED),
    Promise("time", "exceed its limits on time and processor time", Level.LIMITED),
    Promise(
        "numbers",
        "make the grader calculate for longer than a submission may take, by what it returns",
        Level.LIMITED,
    ),
    Promise("memory", "use more memory than its limit (Linux)", Level.LIMITED),
    Promise(
        "inherit", "inherit environment variables, open files or standard input of the kit", Level.LIMITED
    ),
    Promise("frames", "change its level, or lose its grade, by what it sends to the kit", Level.LIMITED),
    Promise("read", "read or list files that it was not granted", Level.FILTERED),
    Promise(
        "solutions", "read solutions, references and secret seeds installed with the kit", Level.FILTERED
    ),
    Promise("write", "write, create, rename or remove files outside its scratch folder", Level.FILTERED),
    Promise("attributes", "change permissions, times, owners and flags of files", Level.FILTERED),
    Promise("start", "start other processes and programs", Level.FILTERED),
    Promise("network", "use the network and local sockets", Level.FILTERED),
    Promise(
        "processes",
        "signal, trace, limit or read other processes, or use up the machine's signals, timers and AIO requests",
        Level.FILTERED,
    ),
    Promise("rights", "raise its limits, become another user, mount, or change the system", Level.FILTERED),
    Promise("kernel", "use bpf, io_uring, keyrings, userfaultfd or performance events", Level.FILTERED),
    Promise(
        "uncounted",
        "use memory or disk that no limit counts (memfd, System V, pages in pipes, files in flight)",
        Level.FILTERED,
    ),
    Promise(
        "order",
        "have anything shown to students that one of its runs does after another has seen a secret of the same grading",
        Level.FILTERED,
    ),
    Promise("stat", "learn by stat() that a file exists, its size and its times", Level.SEPARATE),
    Promise("access times", "leave traces for later programs in access times of files", Level.SEPARATE),
    Promise("list", "learn which processes run", Level.SEPARATE),
    Promise(
        "disk",
        "fill the disk even briefly (at level 1 too, wherever the kit may mount; else it is ended once that is found)",
        Level.SEPARATE,
    ),
    Promise(
        "threads",
        "start more threads than its limit (from level 1 on, if the kit is not root, or may make control groups)",
        Level.ANOTHER_USER,
    ),
    Promise("user", "run as the same user as the kit or another run", Level.ANOTHER_USER),
    Promise("locks", "hold locks, of whichever kind, on files that other programs may read too", None),
    Promise(
        "cache",
        "leave a message for a later program in what of common files and names, found or not, lies in memory",
        None,
    ),
    Promise(
        "load", "learn how many processes run, how busy the machine is and how much of its disk is free", None
    ),
)


def promises_since(level: Level | None) -> list[Promise]:
    """Returns the promises that begin to hold at this level; None: those that hold at none."""
    return [promise for promise in PROMISES if promise.since == level]
