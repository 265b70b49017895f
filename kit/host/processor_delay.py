"""For how long a process was ready to compute and had no processor: what a busy machine takes from it, as Linux counts it."""

from __future__ import annotations

import os
from contextlib import suppress

from kit.host.sandbox.reaper import descendants


def delayed_s(pid: int) -> float:
    """Returns how long the process has waited for a processor [s]: the longest of its threads. 0 where it cannot be known."""
    delays_ns = [0]
    with suppress(OSError):  # it has ended, or this kernel does not tell
        for thread in os.listdir(f"/proc/{pid}/task"):
            with open(f"/proc/{pid}/task/{thread}/schedstat", "rb") as file:
                delays_ns.append(int(file.read().split()[1]))
    return max(delays_ns) / 1e9


def family_delayed_s(pid: int) -> float:
    """Returns the same of a process and of those below it, which it may wait for: the longest of them [s]."""
    return max(map(delayed_s, (pid, *descendants(pid))))
