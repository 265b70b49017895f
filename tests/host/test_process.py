"""What honest and hostile files can and cannot do, at the level that needs nothing of the machine.

The files are functions, the simplest kind of process; nodes live in the same process (see test_node_process).
"""

from __future__ import annotations

import dataclasses
import os
import signal
import subprocess
import sys
import tempfile
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.program_start import MAX_SOURCE
from kit.host.sandbox import landlock
from kit.host.sandbox.limits import GRADER_LIMITS, MIB, Limits
from kit.host.sandbox.sandbox_config import Level
from kit.host.student_functions import StudentFunctions
from tests.host.conftest import LINUX, QUICK, Student


def fail(file: Path, limits: Limits = QUICK) -> Failure:
    """The failure of a file whose function ``f`` is called once."""
    before = _folders()
    with pytest.raises(StudentCodeError) as caught, StudentFunctions(file, limits=limits) as functions:
        functions.call_batch("f", [{}])
    assert str(caught.value) == str(caught.value.failure)
    assert _folders() == before, "a folder was left behind"
    return caught.value.failure


def _folders() -> set[str]:
    return {path.name for path in Path(tempfile.gettempdir()).glob("kit-*")}


@pytest.fixture(autouse=True)
def _own_temporary_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Runs make their folders where only this test looks."""
    folder = tmp_path / "temporary"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))


def test_functions_answer_in_order(student: Student) -> None:
    file = student(
        """
        from math import hypot

        def reward(x, y, *, collision=False):
            return hypot(x, y) - collision

        def _private(): ...
        """
    )
    with StudentFunctions(file, limits=QUICK) as functions:
        assert functions.names == ("reward",)
        batch: list[dict[str, Any]] = [
            {"x": 3, "y": 4, "collision": False},
            {"x": 0.1, "y": 0.0, "collision": True},
        ]
        assert functions.call_batch("reward", batch) == [5.0, -0.9]
        assert functions.call_batch("reward", [{"x": 6, "y": 8}]) == [10.0]
        assert functions.call_batch("reward", []) == []
        assert functions.failure is None


def test_numbers_arrive_to_the_bit(student: Student) -> None:
    values = [0.1, 1e-308, 2**53 - 1.0, -0.0, 1 / 3, 5e-324]
    with StudentFunctions(student("def same(x): return x"), limits=QUICK) as functions:
        back = functions.call_batch("same", [{"x": value} for value in values])
    assert [value.hex() for value in back] == [value.hex() for value in values]


@pytest.mark.parametrize(
    ("source", "kind", "line", "words"),
    [
        ("def f():\n  return 1 / 0", FailureKind.EXCEPTION, 2, "ZeroDivisionError: division by zero (in f)"),
        ("x = 3\ny = x.z\ndef f(): ...", FailureKind.EXCEPTION, 2, "AttributeError"),
        ("def f(:\n  pass", FailureKind.SYNTAX, 1, "SyntaxError"),
        ("def f():\npass", FailureKind.SYNTAX, 2, "IndentationError"),
        ("import numpyy\ndef f(): ...", FailureKind.IMPORT, 1, "No module named 'numpyy'"),
        ("import sys\ndef f():\n  sys.exit(3)", FailureKind.EXIT, 3, "status 3"),
        ("def f():\n  exit()", FailureKind.EXIT, 2, "Let it return"),
        ("def f():\n  quit('no way')", FailureKind.EXIT, 2, "no way"),
        ("raise SystemExit\ndef f(): ...", FailureKind.EXIT, 1, "Let it return"),
        ("import os\nos._exit(0)", FailureKind.EXIT, None, "os._exit(0)"),
        ("import os\ndef f():\n  os._exit(5)", FailureKind.EXIT, None, "os._exit(5)"),
        ("def f(missing): return 1", FailureKind.EXCEPTION, None, "missing"),
        ("def f(): return input()", FailureKind.EXCEPTION, 1, "EOFError"),
        ("def f(): return f()", FailureKind.EXCEPTION, 1, "RecursionError"),
        ("def f(): return open('secret')", FailureKind.EXCEPTION, 1, "FileNotFoundError"),
        ("class E(Exception):\n  def __str__(self): raise E\ndef f(): raise E", FailureKind.EXCEPTION, 3, "E (in f)"),
        ("def g(): return 1.0", FailureKind.IMPORT, None, "no function f()"),
        ("f = 3", FailureKind.IMPORT, None, "no function f()"),
    ],
)  # fmt: skip
def test_every_failure_says_what_and_where(
    student: Student, source: str, kind: FailureKind, line: int | None, words: str
) -> None:
    failure = fail(student(source))
    assert (failure.kind, failure.line) == (kind, line)
    assert words in failure.message
    assert failure.file in (None, "work.py")


@pytest.mark.parametrize(
    "value",
    [
        "None",
        "True",
        "'1'",
        "[1.0]",
        "float('nan')",
        "-float('inf')",
        "10**400",
        "1j",
        "object()",
        "10**5000",
    ],
)
def test_only_a_finite_number_is_a_reward(student: Student, value: str) -> None:
    failure = fail(student(f"\n\ndef f():\n  return {value}"))
    assert (failure.kind, failure.file, failure.line) == (FailureKind.EXCEPTION, "work.py", 3)
    assert "f() must return a finite number" in failure.message


def test_a_number_is_a_number_whatever_its_class(student: Student) -> None:
    file = student(
        """
        import numpy
        class Mine(float): ...
        def f(kind):
            return {"float32": numpy.float32(0.5), "int64": numpy.int64(2), "mine": Mine(1.5), "int": 3}[kind]
        """
    )
    with StudentFunctions(file, limits=QUICK) as functions:
        assert functions.call_batch(
            "f", [{"kind": kind} for kind in ("float32", "int64", "mine", "int")]
        ) == [
            0.5,
            2,
            1.5,
            3,
        ]


def test_a_failure_deep_in_a_library_names_the_students_line(student: Student) -> None:
    student("def deeper(text):\n    import json\n    return json.loads(text)", "friend.py")
    file = student("import friend\n\n\ndef f():\n    return friend.deeper('{')")
    failure = fail(file)
    assert (failure.file, failure.line) == ("friend.py", 3)
    with StudentFunctions(file, limits=QUICK) as functions:
        with pytest.raises(StudentCodeError):
            functions.call_batch("f", [{}])
        shown = [line.text for line in functions.take_output().lines]
    assert any("work.py:5 in f: return friend.deeper('{')" in line for line in shown)
    assert not any("json/" in line for line in shown)


@pytest.mark.leans_on_clock("the program must be in its loop within the limit of 0.4 s")
@pytest.mark.long
@pytest.mark.parametrize(
    ("source", "line", "function"),
    [
        ("def f():\n  while True:\n    pass", (2, 3), "f()"),
        ("import time\ndef f():\n  time.sleep(100)", (3,), "f()"),
        ("def f():\n  g()\ndef g():\n  sum(iter(int, 1))", (4,), "g()"),
        ("import signal\ndef f():\n  signal.signal(signal.SIGTERM, signal.SIG_IGN)\n  while 1: pass", (4,), "f()"),
        ("class Sticky:\n  def __del__(self):\n    while 1: pass\ndef f():\n  Sticky()", (3,), "__del__()"),
        ("import signal\ndef f():\n  for number in (signal.SIGALRM, signal.SIGPROF):\n    signal.signal(number, signal.SIG_IGN)\n  while 1: pass", (None,), "the program"),
        ("import re\ndef f():\n  re.match('(a+)+$', 'a' * 60 + 'b')", (3,), "f()"),
    ],
)  # fmt: skip
def test_what_never_comes_back_is_ended(
    student: Student, source: str, line: tuple[int | None, ...], function: str
) -> None:
    limits = dataclasses.replace(QUICK, reply_s=0.4, wall_factor=10)
    failure = fail(student(source), limits)
    assert failure.kind is FailureKind.TIMEOUT
    assert failure.line in line
    limit = "4 s" if "sleep" in source else "0.4 s of processor time"
    assert failure.message.startswith(f"{function} did not return within {limit}.")


@pytest.mark.long
def test_a_busy_machine_stops_nobody(student: Student) -> None:
    """Half a second of processor time takes longer than the limit by the wall clock, and is no more than it."""
    file = student(
        """
        import time
        def f():
            began, wall = time.process_time(), time.perf_counter()
            while time.process_time() - began < 0.5: pass
            return time.perf_counter() - wall
        """
    )
    busy = [
        subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(3 * (os.cpu_count() or 1))
    ]
    try:
        with StudentFunctions(
            file, limits=dataclasses.replace(QUICK, reply_s=0.8, wall_factor=30)
        ) as functions:
            assert functions.call_batch("f", [{}])[0] > 0.5
    finally:
        for each in busy:
            each.kill()
            each.wait()


@pytest.mark.long
@LINUX
def test_who_gets_no_processor_is_not_ended_by_the_wall_clock(student: Student) -> None:
    """Beside a process that has the only processor for nearly all of the time."""
    file = student(
        """
        import os, time
        def f():
            os.nice(19)
            began = time.process_time()
            while time.process_time() - began < 0.05: pass
            return 1.0
        """
    )
    processors = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(processors)})
    busy = subprocess.Popen([sys.executable, "-c", "while True: pass"])
    try:
        with StudentFunctions(
            file, limits=dataclasses.replace(QUICK, reply_s=1.0, wall_factor=0.5)
        ) as functions:
            assert functions.call_batch("f", [{}]) == [1.0]
    finally:
        os.sched_setaffinity(0, processors)
        busy.kill()
        busy.wait()


@pytest.mark.long
@LINUX
def test_who_computes_now_and_then_and_sleeps_is_ended_by_the_wall_clock(student: Student) -> None:
    file = student(
        """
        import time
        def f():
            while True:
                until = time.process_time() + 0.005
                while time.process_time() < until: pass
                time.sleep(0.05)
        """
    )
    failure = fail(file, dataclasses.replace(QUICK, reply_s=1.0, wall_factor=1.0))
    assert failure.kind is FailureKind.TIMEOUT
    assert "processor time" not in failure.message


@pytest.mark.long
def test_a_file_that_never_loads_is_ended(student: Student) -> None:
    limits = dataclasses.replace(QUICK, start_s=1.5)
    failure = fail(student("x = 1\nwhile x:\n  x += 1"), limits)
    assert (failure.kind, failure.file) == (FailureKind.TIMEOUT, "work.py")
    assert failure.line in (2, 3)
    assert "start" in failure.message


@pytest.mark.long
def test_the_budget_in_all(student: Student) -> None:
    limits = dataclasses.replace(QUICK, total_s=0.5)
    file = student("import time\ndef f():\n  time.sleep(0.2)\n  return 1")
    with StudentFunctions(file, limits=limits) as functions:
        assert functions.call_batch("f", [{}]) == [1.0]
        assert functions.call_batch("f", [{}]) == [1.0]
        with pytest.raises(StudentCodeError, match=r"total time of 0\.5 s") as caught:
            functions.call_batch("f", [{}])
    assert caught.value.failure.kind is FailureKind.TIMEOUT


@pytest.mark.long
def test_the_budget_of_processor_time(student: Student) -> None:
    limits = dataclasses.replace(QUICK, cpu_s=1, reply_s=20.0)
    failure = fail(student("import signal\ndef f():\n  while 1: pass"), limits)
    assert (failure.kind, failure.line) == (FailureKind.TIMEOUT, 3)
    assert "processor time" in failure.message


@pytest.mark.long
@pytest.mark.skipif(sys.platform != "linux", reason="macOS does not limit memory")
@pytest.mark.parametrize(
    "source",
    [
        "def f():\n  x = []\n  while True: x.append('x' * 10_000_000)",
        "x = bytearray(10**12)\ndef f(): ...",
        "def f():\n  x = [0]\n  while True: x += x",
    ],
)
def test_memory_is_limited(student: Student, source: str) -> None:
    failure = fail(student(source), dataclasses.replace(QUICK, memory=300 * MIB, reply_s=10))
    assert failure.kind is FailureKind.MEMORY
    assert "300 MiB" in failure.message
    assert failure.line is not None


def test_a_crash_in_compiled_code_says_where(student: Student) -> None:
    failure = fail(student("import ctypes\ndef f():\n  ctypes.string_at(0)"))
    assert (failure.kind, failure.file, failure.line) == (FailureKind.CRASH, "work.py", 3)


def test_a_flood_of_prints_is_drained_and_dropped(student: Student) -> None:
    file = student("def f():\n  for i in range(20000): print('x' * 100)\n  print('end')\n  return 1")
    with StudentFunctions(file, limits=dataclasses.replace(QUICK, reply_s=10)) as functions:
        assert functions.call_batch("f", [{}]) == [1.0]
        printed = functions.take_output()
        assert sum(len(line.text) for line in printed.lines) <= QUICK.output
        assert printed.dropped > 1_900_000
        assert functions.call_batch("f", [{}]) == [1.0]


def test_prints_arrive_with_the_answer_and_harmless(student: Student) -> None:
    file = student(
        "import sys\ndef f():\n  print('::error::\\x1b[2J')\n  print('bad', file=sys.stderr)\n  return 1"
    )
    with StudentFunctions(file, limits=QUICK) as functions:
        functions.call_batch("f", [{}])
        lines = functions.take_output().lines
    assert sorted(line.stream for line in lines) == ["err", "out"]
    assert all(line.text.isprintable() for line in lines)


PIPE = """
import base64, os, socket, struct, json
def pipe():
    for fd in range(3, 64):
        try:
            if os.readlink(f"/proc/self/fd/{fd}").startswith("socket:"): return fd
        except OSError: pass
def values(*numbers):
    return base64.b64encode(struct.pack(f"<{len(numbers)}d", *numbers)).decode()
def frame(content):
    data = json.dumps(content).encode()
    return struct.pack(">I", len(data)) + data
"""


@LINUX
@pytest.mark.parametrize(
    "attack",
    [
        "os.write(pipe(), b'x' * 100)",
        "os.write(pipe(), struct.pack('>I', 2**31))",
        "os.write(pipe(), struct.pack('>I', 70_000) + b'[' * 70_000)",
        "os.write(pipe(), frame(['values', 1, values(99)]))",
        "os.write(pipe(), frame(['values', 1, values(99)]) * 2)",
        "os.write(pipe(), frame(['values', 2, values(99)]))",
        "os.write(pipe(), frame(['values', 1, values(1, 2, 3)])); os.read(pipe(), 1)",
        "os.write(pipe(), struct.pack('>I', 20) + b'[' * 200 + b'NaN')",
        "os.write(pipe(), frame(['values', 1, values(float('nan'))])[:-1])",
        "os.closerange(3, 64)",
        "socket.socket(fileno=pipe()).shutdown(socket.SHUT_RDWR)",
        "os.close(pipe())",
    ],
)
def test_a_broken_conversation_ends_it(student: Student, attack: str) -> None:
    """At worst a file forges the number that it may choose anyway; then its next answer is one too many."""
    file = student(f"{PIPE}\ndef f():\n    {attack}\n    return 1")
    before = _folders()
    with StudentFunctions(file, limits=QUICK) as functions:
        for _ in range(3):
            with suppress(StudentCodeError):
                functions.call_batch("f", [{}])
        assert functions.failure is not None
        assert functions.failure.kind in (FailureKind.PROTOCOL, FailureKind.TIMEOUT)
    assert _folders() == before


@pytest.mark.leans_on_clock("the end must come soon after the deadline")
@pytest.mark.long
@LINUX
def test_bytes_that_dribble_do_not_extend_the_deadline(student: Student) -> None:
    file = student(
        f"{PIPE}\ndef f():\n    import time\n    for byte in frame(['values', 1, values(1)] + [0] * 99):\n"
        "        os.write(pipe(), bytes([byte])); time.sleep(0.1)"
    )
    began = time.monotonic()
    assert fail(file, dataclasses.replace(QUICK, wall_factor=2.0)).kind is FailureKind.TIMEOUT
    assert time.monotonic() - began < 5


def _is_running(marker: str) -> bool:
    for process in Path("/proc").glob("[0-9]*"):
        try:
            if marker in (process / "cmdline").read_text():
                return True
        except OSError:
            continue
    return False


DAEMON = """
import os, sys, time
def f():
    if os.fork() == 0:
        os.setsid()
        if os.fork() == 0:
            os.execv(sys.executable, [sys.executable, "-c", "import time; time.sleep(300)", {marker!r}])
        os._exit(0)
    os.wait()
    time.sleep(0.3)
    return 1
"""


@pytest.mark.long
@LINUX
def test_a_daemon_is_not_left_behind(student: Student, tmp_path: Path) -> None:
    marker = f"daemon-of-{tmp_path}"
    with StudentFunctions(student(DAEMON.format(marker=marker)), limits=QUICK) as functions:
        functions.call_batch("f", [{}])
        assert _is_running(marker)
    assert not _is_running(marker)


@LINUX
def test_killing_the_process_above_ends_only_itself(student: Student) -> None:
    failure = fail(student("import os\ndef f():\n  os.kill(os.getppid(), 9)\n  while 1: pass"))
    assert failure.kind in (FailureKind.KILLED, FailureKind.TIMEOUT)


@pytest.mark.long
@LINUX
@pytest.mark.parametrize("end", ["os.kill(os.getpid(), 9)", "os._exit(0)"])
def test_when_the_kit_dies_the_child_dies_too(student: Student, tmp_path: Path, end: str) -> None:
    marker = f"orphan-of-{tmp_path}"
    file = student(DAEMON.format(marker=marker))
    code = (
        f"import os, pathlib, tempfile; tempfile.tempdir = {str(tmp_path / 'temporary')!r}\n"
        f"from kit.host.student_functions import StudentFunctions\n"
        f"functions = StudentFunctions(pathlib.Path({str(file)!r}))\n"
        f"functions.call_batch('f', [{{}}]); print('started', flush=True); {end}"
    )
    run = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=False
    )
    assert run.stdout == "started\n", run.stderr
    deadline = time.monotonic() + 10
    while (_is_running(marker) or _folders()) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert not _is_running(marker)
    assert not _folders()


def test_what_a_file_leaves_in_its_folder_goes_with_it(student: Student) -> None:
    file = student(
        """
        import os
        def f():
            os.makedirs("a/b/c")
            open("a/b/c/file", "w").write("x")
            os.chmod("a/b", 0)
            path = ""
            for _ in range(300):
                os.mkdir("d" * 20); os.chdir("d" * 20)
            return 1
        """
    )
    with StudentFunctions(file, limits=QUICK) as functions:
        assert _folders()
        # Too deep to be counted: where the count of its files comes in time, the program is ended for them.
        with suppress(StudentCodeError):
            functions.call_batch("f", [{}])
    assert not _folders()


@pytest.mark.usefixtures("cold_start")
def test_nothing_of_ours_is_in_its_surroundings(student: Student, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SECRET_TOKEN", "xyzzy")
    monkeypatch.setenv("PYTHONPATH", "/nowhere")
    secret = os.open("/dev/null", os.O_RDONLY)
    os.set_inheritable(secret, True)
    file = student(
        """
        import os, sys
        def f():
            assert "SECRET_TOKEN" not in os.environ and "PYTHONPATH" not in os.environ
            assert not os.listdir() and os.environ["HOME"] == os.getcwd()
            open_files = [os.readlink(f"/proc/self/fd/{fd}") for fd in range(256) if _is_open(fd)]
            # Some systems' libffi, of ctypes, holds its own file open.
            others = [name for name in open_files if "/libffi.so" not in name]
            assert len(others) == 4, open_files
            assert os.getpgrp() == os.getpid()
            return 1
        def _is_open(fd):
            try: os.fstat(fd)
            except OSError: return False
            return True
        def lacks(module):
            try: __import__(module)
            except ImportError: return 1
            return 0
        """
    )
    try:
        with StudentFunctions(file, limits=QUICK) as functions:
            assert functions.call_batch("f", [{}]) == [1.0]
            assert functions.call_batch("lacks", [{"module": "tests"}, {"module": "grader"}]) == [1.0, 1.0]
    finally:
        os.close(secret)


@pytest.mark.usefixtures("cold_start")
@pytest.mark.long
def test_the_order_of_a_set_and_chance_are_the_same_in_every_run(student: Student) -> None:
    file = student(
        """
        import random
        order = list({"north", "east", "south", "west", "up", "down"})
        def f(i):
            return order.index("north") * 10 + order.index("up") + random.random()
        def numpys(i):
            import numpy
            return numpy.random.rand()
        """
    )
    runs = []
    for seed in (7, 7, 8):
        with StudentFunctions(file, seed=seed, limits=QUICK) as functions:
            runs.append(
                [functions.call_batch(name, [{"i": i} for i in range(3)]) for name in ("f", "numpys")]
            )
    assert runs[0] == runs[1]
    assert runs[0][0] != runs[2][0]
    assert runs[0][1] != runs[2][1]


@pytest.mark.usefixtures("cold_start")
def test_files_of_the_folder_do_not_hide_the_librarys(student: Student) -> None:
    student("raise RuntimeError('not me')", "json.py")
    student("FACTOR = 2.5", "friend.py")
    with StudentFunctions(
        student("import json, friend\ndef f(): return friend.FACTOR"), limits=QUICK
    ) as functions:
        assert functions.call_batch("f", [{}]) == [2.5]


def test_what_runs_is_what_was_there_at_the_start(student: Student) -> None:
    file = student("def f(): return 1")
    with StudentFunctions(file, limits=QUICK) as functions:
        file.write_text("def f(): return 2")
        assert functions.call_batch("f", [{}]) == [1.0]
    assert not (file.parent / "__pycache__").exists()


def test_a_file_that_cannot_be_read(tmp_path: Path, student: Student) -> None:
    assert "No such file" in fail(tmp_path / "missing.py").message
    assert "directory" in fail(tmp_path).message
    os.mkfifo(tmp_path / "pipe.py")
    assert "not a file" in fail(tmp_path / "pipe.py").message
    assert "larger than" in fail(student("#" * MAX_SOURCE + "\n")).message


def test_source_in_any_encoding_it_declares(student: Student) -> None:
    file = student("")
    file.write_bytes("# coding: latin-1\ndef f(): return float(len('ü'))".encode("latin-1"))
    with StudentFunctions(file, limits=QUICK) as functions:
        assert functions.call_batch("f", [{}]) == [1.0]
    file.write_bytes(b"x = '\xff'")
    assert fail(file).kind is FailureKind.SYNTAX


def test_records_must_be_plain(student: Student) -> None:
    with StudentFunctions(student("def f(x): return 1"), limits=QUICK) as functions:
        for batch in (
            [{"x": [float("nan")]}],
            [{"x": object()}],
            [{"x": 1}, {"y": 1}],
            [{"x": 1}, {"x": 1, "y": 2}],
        ):
            with pytest.raises((ValueError, TypeError)):
                functions.call_batch("f", batch)
        assert functions.call_batch("f", [{"x": [1, None, {"y": "z"}]}, {"x": None}]) == [1.0, 1.0]
        assert functions.call_batch("f", [{"x": float("nan")}, {"x": float("inf")}]) == [1.0, 1.0]


def test_columns_and_records_are_the_same(student: Student) -> None:
    file = student("def f(x, hit, name='n'): return x + hit + len(name)")
    x = np.linspace(0, 1, 50)
    hit = x > 0.5
    with StudentFunctions(file, limits=QUICK) as functions:
        columns = functions.call_columns("f", {"x": x, "hit": hit})
        records = functions.call_batch(
            "f", [{"x": float(a), "hit": bool(b)} for a, b in zip(x, hit, strict=True)]
        )
        assert list(columns) == records == [float(a) + bool(b) + 1 for a, b in zip(x, hit, strict=True)]
        assert list(
            functions.call_columns("f", {"x": np.array([0.5], "f"), "hit": [2], "name": ["abc"]})
        ) == [5.5]
        with pytest.raises(ValueError, match="the same length"):
            functions.call_columns("f", {"x": x, "hit": hit[1:]})


def test_a_batch_larger_than_the_pipe(student: Student) -> None:
    batch = [{"x": i / 7, "name": "n" * 50} for i in range(20_000)]
    limits = dataclasses.replace(QUICK, frame=2 * MIB, reply_s=20)
    with StudentFunctions(student("def f(x, name): return x"), limits=limits) as functions:
        assert functions.call_batch("f", batch) == [record["x"] for record in batch]


def test_closing_twice_and_from_any_state(student: Student) -> None:
    functions = StudentFunctions(student("def f(): return 1"), limits=QUICK)
    functions.close()
    functions.close()
    assert not _folders()


def test_signals_for_the_terminals_group_do_not_reach_it(student: Student) -> None:
    """Ctrl-C goes to everything in the face's session; a student's process is in its own."""
    with StudentFunctions(student("import os\ndef f(): return os.getsid(0)"), limits=QUICK) as functions:
        (session,) = functions.call_batch("f", [{}])
        assert session != os.getsid(0)
        os.killpg(int(session), signal.SIGCONT)


LOCKS = pytest.mark.skipif(landlock.abi() < 3, reason="this kernel cannot lock a process in (Landlock)")
WRITE_FOR_EVER = """
import os, time
def f():
    number = 0
    while True:
        number += 1
        {write}
"""
WRITES = {
    "large files": "open(f'{number % 50}', 'ab').write(bytes(1 << 18)) if number < 1000 else time.sleep(1)",
    "many files": "open(f'{number}', 'w').close() if number < 5000 else time.sleep(1)",
    "folders in folders": "(os.mkdir('d'), os.chdir('d')) if number < 600 else time.sleep(1)",
    "deleted files": "(kept := globals().setdefault('kept', [])).append(open('x', 'wb')) or kept[-1].write(bytes(1 << 20)) "
    "and kept[-1].flush() or os.unlink('x') if number < 40 else time.sleep(1)",
}


@pytest.mark.long
@pytest.mark.parametrize("level", [Level.LIMITED, pytest.param(Level.FILTERED, marks=LOCKS)])
@pytest.mark.parametrize("write", WRITES.values(), ids=WRITES)
def test_what_it_writes_is_limited_and_removed(write: str, level: Level, tmp_path: Path) -> None:
    """However it is written. It goes on for ever afterwards, so it is ended on any machine."""
    file = tmp_path / "program.py"
    file.write_text(WRITE_FOR_EVER.format(write=write))
    limits = dataclasses.replace(GRADER_LIMITS, reply_s=100.0, scratch=8 * MIB, files=300)
    with (
        pytest.raises(StudentCodeError) as caught,
        StudentFunctions(file, limits=limits, level=level) as functions,
    ):
        functions.call_batch("f", [{}])
    assert caught.value.failure.kind is FailureKind.DISK
    assert "8 MiB or 300 files" in caught.value.failure.message
    assert not _folders()
