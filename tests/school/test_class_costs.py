"""What programs cost is measured on the programs themselves."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from kit.school import class_costs

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="only Linux says what programs use (/proc)")
BYTES = 64 << 20
NESTED = f"""
import subprocess, sys
held = bytearray({BYTES})
inner = subprocess.Popen([sys.executable, "-c", "held = bytearray({BYTES}); print('ready', flush=True); input()"],
                         start_new_session=True, stdin=subprocess.PIPE)
input()
inner.communicate(b"\\n")
"""


@contextmanager
def nested() -> Iterator[subprocess.Popen[str]]:
    """A process, and one that it has started in a session of its own, as a student's program is."""
    process = subprocess.Popen(
        [sys.executable, "-c", NESTED],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    assert process.stdout
    assert process.stdin
    try:
        process.stdout.readline()
        yield process
    finally:
        process.communicate("\n")


def test_a_program_that_another_has_started_counts_with_it() -> None:
    with nested() as process:
        family = class_costs._family_of(process.pid)
        assert len(family) == 2
        assert sorted(class_costs._processes_of({process.pid})) == sorted(family)
        assert sum(map(class_costs._memory, family)) > 2 * BYTES
    assert class_costs._memory(process.pid) == 0.0
    assert class_costs._processor_s(process.pid) == 0.0


def test_processor_time_is_that_of_the_process() -> None:
    code = "while __import__('time').process_time() < 0.5: pass\nprint('ready', flush=True); input()"
    process = subprocess.Popen([sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    assert process.stdout
    process.stdout.readline()
    used = class_costs._processor_s(process.pid)
    process.communicate(b"\n")
    assert 0.4 < used < 1.5


@pytest.mark.long
@pytest.mark.pty
def test_a_drive_and_a_check_are_measured_here() -> None:
    cost = class_costs.measure_costs()
    assert 0.0 < cost.drive_cores < class_costs.this_machine().cores
    assert 40e6 < cost.drive_bytes < 1e9
    assert 0.1 < cost.check_core_s < 60.0
    assert cost.check_s > 0.1
    assert 30e6 < cost.check_bytes < 2e9
