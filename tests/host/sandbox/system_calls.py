"""Lists the system calls that confined programs make: ``python -m tests.host.sandbox.system_calls COMMAND...`` runs a command
under strace, and prints every call that a process made after it was confined, how often, and what the filter says of it.

The tables of ``kit.host.sandbox.seccomp`` come from runs of all solutions of the lessons, torch, numba, threads and asyncio::

    python -m tests.host.sandbox.system_calls python -m grader check SOLUTION --assignment lessons/01-drive/square
"""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

from kit.host.sandbox import seccomp

LINE = re.compile(r"(?P<process>\d+)\s+(?:<\.\.\. )?(?P<call>\w+)(?P<rest>.*)")
NEW_THREAD = re.compile(r"= (\d+)\s*$")


def confined_calls(lines: Iterable[str]) -> Counter[str]:
    """Counts the calls of the processes that have installed a filter, and of their threads, in strace's output."""
    confined: set[str] = set()
    calls: Counter[str] = Counter()
    for line in lines:
        found = LINE.match(line)
        if found is None:
            continue
        process, call, rest = found.group("process", "call", "rest")
        if call == "prctl" and "PR_SET_SECCOMP" in rest:
            confined.add(process)
        elif process in confined:
            calls[call] += 1
            new = NEW_THREAD.search(rest)
            if call in ("clone", "clone3") and new is not None:
                confined.add(new.group(1))
    return calls


def verdict(call: str) -> str:
    """Returns what the filter says of a call."""
    if call in seccomp.ALLOWED:
        return "allowed"
    if call in seccomp.checked_calls(0) or call in ("clone", "socketpair"):
        return "depends on an argument"
    return "refused" if call in seccomp.DENIED else "unknown"


def main(command: list[str]) -> int:
    """Runs the command and prints its calls; returns 1 if a call is in no table."""
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "log"
        subprocess.run(["strace", "-f", "-qq", "-o", log, *command], check=False)
        calls = confined_calls(log.read_text(errors="replace").splitlines())
    for call, count in calls.most_common():
        print(f"{count:9,}  {call:<24} {verdict(call)}")
    return int(any(verdict(call) == "unknown" and call != "clone3" for call in calls))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
