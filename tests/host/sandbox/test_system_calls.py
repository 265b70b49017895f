"""The list of calls that confined programs make is read from strace's output as it is written."""

from __future__ import annotations

from tests.host.sandbox.system_calls import confined_calls, verdict

LOG = """\
10 openat(AT_FDCWD, "x", O_RDONLY) = 3
11 prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, {len=900, filter=0x1}) = 0
10 execve("/bin/true", ["true"], 0x1) = 0
11 read(3, "x", 1) = 1
11 clone(child_stack=0x1, flags=CLONE_VM|CLONE_THREAD) = 12
12 futex(0x1, FUTEX_WAIT) = 0
11 <... read resumed> "y", 1) = 1
"""


def test_only_what_comes_after_the_filter_counts_threads_included() -> None:
    assert dict(confined_calls(LOG.splitlines())) == {"read": 2, "clone": 1, "futex": 1}


def test_every_call_has_a_verdict() -> None:
    told = [verdict(call) for call in ("read", "ioctl", "clone", "fork", "no_such_call")]
    assert told == ["allowed", "depends on an argument", "depends on an argument", "refused", "unknown"]
