"""What a locked-in program cannot do, on every level that this machine allows, and what it still can.

Each attack is a function that returns 1 if it got what it wanted. A refusal is an OSError, and 0.
"""

from __future__ import annotations

import dataclasses
import itertools
import os
import resource
import socket
import struct
import subprocess
import tempfile
import textwrap
import time
from array import array
from collections.abc import Sequence
from functools import cache
from pathlib import Path

import pytest

from kit.controllers import find_controller
from kit.host.failure import FailureKind, StudentCodeError
from kit.host.node_process import NodeProcess
from kit.host.sandbox import landlock, seccomp
from kit.host.sandbox.limits import MIB
from kit.host.sandbox.probe import SandboxSupport, can_mount_scratch, highest_level_up_to, probe_levels
from kit.host.sandbox.sandbox_config import Level
from kit.host.student_functions import StudentFunctions
from kit.msg.geometry_msgs import Twist
from kit.msg.sensor_msgs import LaserScan
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node
from tests.host.conftest import LINUX, QUICK, Student

pytestmark = pytest.mark.usefixtures("cold_start")


def above(file: Path) -> list[Path]:
    """The folders that somebody else must be able to enter to read a test's file; with xdist one more."""
    return list(itertools.takewhile(lambda folder: folder != Path(tempfile.gettempdir()), file.parents))


@cache
def _supports() -> tuple[SandboxSupport, ...]:
    return probe_levels()


@pytest.fixture(params=list(Level)[1:], ids=lambda level: f"L{level}")
def level(request: pytest.FixtureRequest) -> Level:
    """Every level that locks in, where it can be had."""
    wanted: Level = request.param
    support = _supports()[wanted]
    if not support.is_available:
        pytest.skip(support.reason)
    return wanted


ATTACKS_BY_PROMISE = {
    "read": {
        "read a file outside": "return len(open(secret).read())",
        "list a folder outside": "return len(os.listdir(os.path.dirname(secret)))",
        "read the passwords' file": "return len(open('/etc/passwd').read())",
        "read through a link": "os.symlink(secret, 'link'); return len(open('link').read())",
        "read through a hard link": "os.link(secret, 'link'); return len(open('link').read())",
        "read an attribute outside": "return 1 + len(os.listxattr(secret))",
        "open a file by handle": "return 1 + call(304, 265, 3, None, 0)",
    },
    "write": {
        "write a file outside": "open(secret, 'a').write('x'); return 1",
        "make a file outside": "open(secret + '.new', 'w'); return 1",
        "make a file in its own folder": "open(os.path.dirname(__file__) + '/new', 'w'); return 1",
        "change its own source": "open(__file__, 'a').write('x'); return 1",
        "make a file in /tmp": "open('/tmp/new-of-a-test', 'w'); return 1",
        "make a file in shared memory": "open('/dev/shm/new-of-a-test', 'w'); return 1",
        "shorten a file outside": "os.truncate(secret, 0); return 1",
        "remove a file outside": "os.unlink(secret); return 1",
        "rename a file outside": "os.rename(secret, secret + '2'); return 1",
        "write into the library": "open(os.__file__, 'a'); return 1",
        "have every later Python start it": "import site; open(site.getsitepackages()[0] + '/of-a-test.pth', 'w'); return 1",
        "leave bytecode beside the kit": "import kit; open(os.path.dirname(kit.__file__) + '/__pycache__/of-a-test.pyc', 'w'); return 1",
        "make a file in /var/tmp": "open('/var/tmp/new-of-a-test', 'w'); return 1",
        "have the machine start it": "open('/etc/cron.d/of-a-test', 'w'); return 1",
        "leave a semaphore": "_libc.sem_open.restype = ctypes.c_void_p; return 1 if _libc.sem_open(b'/of-a-test', 0o100, 0o600, 1) else 0",
    },
    "attributes": {
        "change a file's rights": "os.chmod(secret, 0o777); return 1",
        "change a file's time": "os.utime(secret, (0, 0)); return 1",
        "change a file's owner": "os.chown(secret, os.getuid(), os.getgid()); return 1",
        "read a file's flags": "flags = ctypes.c_long(); return 1 + call(16, 29, os.open(__file__, 0), 0x80086601, ctypes.byref(flags))",
        "leave a hint with a file": "import fcntl; return len(fcntl.fcntl(os.open(__file__, 0), 1036, (3).to_bytes(8, 'little')))",
        "set a file's flags": "flags = ctypes.c_long(0x40); return 1 + call(16, 29, os.open(__file__, 0), 0x40086602, ctypes.byref(flags))",
    },
    "start": {
        "fork": "return 1 + os.fork()",
        "start a program": "import subprocess; subprocess.run(['/bin/true']); return 1",
        "spawn a program": "return os.posix_spawn('/bin/true', ['true'], {})",
        "replace itself": "os.execv('/bin/true', ['true'])",
        "start a worker": "import multiprocessing as m; p = m.Process(target=print); p.start(); return 1",
        "vfork past the library": "return 1 + call(58, 1071)",
        "clone3": "return 1 + call(435, 435, None, 0)",
    },
    "network": {
        "connect over TCP_ACCESS": "import socket; socket.create_connection(('127.0.0.1', 9), 1); return 1",
        "send over UDP": "import socket; s = socket.socket(type=socket.SOCK_DGRAM); s.sendto(b'x', ('127.0.0.1', 9)); return 1",
        "open a local socket": "import socket; socket.socket(socket.AF_UNIX); return 1",
        "wait at a name without a file": "import socket; s = socket.socket(socket.AF_UNIX); s.bind(chr(0) + 'of-a-test'); return 1",
        "open a raw socket": "import socket; socket.socket(socket.AF_PACKET, socket.SOCK_RAW); return 1",
    },
    "processes": {
        "signal the process above": "os.kill(os.getppid() or grader, 0); return 1",
        "signal the grader": "os.kill(grader, 0); return 1",
        "signal everybody": "os.kill(-1, 0); return 1",
        "signal its group": "os.kill(0, 0); return 1",
        "signal by descriptor": "os.pidfd_open(grader); return 1",
        "read the grader's environment": "return len(open(f'/proc/{grader}/environ', 'rb').read())",
        "read the grader's memory": "return len(open(f'/proc/{grader}/maps').read())",
        "read the grader's arguments": "return len(open(f'/proc/{grader}/cmdline').read())",
        "open the grader's files": "return len(os.listdir(f'/proc/{grader}/fd'))",
        "trace the grader": "return 1 + call(101, 117, 16, grader, 0, 0)",
        "read the grader's memory at once": "return 1 + call(310, 270, grader, None, 0, None, 0, 0)",
        "limit the grader": "import resource; resource.prlimit(grader, resource.RLIMIT_NOFILE, (9, 9)); return 1",
        "slow the grader down": "os.setpriority(os.PRIO_PROCESS, grader, 19); return 1",
        "hold back whoever opens a file": "import fcntl; file = open(__file__); return 1 + fcntl.fcntl(file, 1024, 1)",
        "watch what others open": "import fcntl; folder = os.open(os.path.dirname(__file__), 0); return 1 + fcntl.fcntl(folder, 1026, 1)",
        "have the grader signalled by a pipe": "import fcntl; ends = os.pipe(); return 1 + fcntl.fcntl(ends[0], 8, grader)",
        "have the grader signalled by a socket": "import socket; end = socket.socketpair()[0]; return 1 + call(16, 29, end.fileno(), 0x8902, ctypes.byref(ctypes.c_int(grader)))",
        "choose the signal of a pipe": "import fcntl; ends = os.pipe(); return 1 + fcntl.fcntl(ends[0], 10, 9)",
        "live on after the kit": "return 1 + call(157, 167, 1, 0, 0, 0, 0)",
        "use up the machine's requests": "context = ctypes.c_ulong(); return 1 + call(206, 0, 8, ctypes.byref(context))",
        "use up its user's signals": "timers = [ctypes.c_int() for _ in range(500)]; return sum(1 + call(222, 107, 1, None, ctypes.byref(timer)) for timer in timers)",
        "write all to the disk": "os.sync(); return 0 if ctypes.get_errno() else 1 + call(162, 81)",
    },
    "rights": {
        "have its memory kept by what cores are piped to": "import resource; resource.setrlimit(resource.RLIMIT_CORE, (0, 0)); return 1",
        "raise its own limits": "import resource; resource.setrlimit(resource.RLIMIT_AS, (2**40, 2**40)); return 1",
        "become another user": "os.setuid(12345); return 1",
        "mount": "return 1 + call(165, 40, b'none', b'.', b'tmpfs', 0, b'')",
        "make a namespace": "return 1 + call(272, 97, 0x10000000)",
        "change its root": "os.chroot('.'); return 1",
        "set the clock": "import time; time.clock_settime(time.CLOCK_REALTIME, 0); return 1",
        "name the machine": "import socket; socket.sethostname('x'); return 1",
        "make a device": "os.mknod('zero', 0o20600, os.makedev(1, 5)); return 1",
    },
    "kernel": {
        "load a filter program": "return 1 + call(321, 280, 0, None, 0)",
        "use a keyring": "return 1 + call(250, 219, 0, -3, 1)",
        "use io_uring": "return 1 + call(425, 425, 1, None)",
        "watch performance": "return 1 + call(298, 241, None, 0, -1, -1, 0)",
        "catch page faults": "return 1 + call(323, 282, 0)",
        "use a call of another architecture": "return 1 + call(0x40000000 + 39, 10**6)",
    },
    "uncounted": {
        "use memory that nobody counts": "return 1 + call(319, 279, b'x', 0)",
        "use shared memory": "made = call(29, 194, 0, 4096, 0o600); return 1 + call(31, 195, made, 0, None)",
        "use semaphores": "made = call(64, 190, 0, 1, 0o600); return 1 + call(66, 191, made, 0, 0)",
        "use a message queue": "made = call(68, 186, 0, 0o600); return 1 + call(71, 187, made, 0, None)",
        "use a named message queue": "return 1 + call(240, 180, b'of-a-test', 0o102, 0o600, None)",
        "leave pages in a pipe": "part = (ctypes.c_size_t * 2)(ctypes.addressof(kept := ctypes.create_string_buffer(9)), 1); return 1 + call(278, 75, os.pipe()[1], part, 1, 0)",
        "copy a pipe's pages": "ends = os.pipe(); os.write(ends[1], b'x'); return 1 + call(276, 77, ends[0], os.pipe()[1], 1, 0)",
        "move pages into a pipe": "return 1 + call(275, 76, os.open(__file__, 0), None, os.pipe()[1], None, 1, 0)",
        "widen a pipe": "import fcntl; return fcntl.fcntl(os.pipe()[1], 1031, 1 << 20)",
        "reserve the disk beyond every limit": "return 1 + call(285, 47, os.open('reserved', os.O_RDWR | os.O_CREAT), 1, ctypes.c_long(0), ctypes.c_long(1 << 20))",
        "send a file that nobody sees": "import socket; ends = socket.socketpair(); return socket.send_fds(ends[0], [b'x'], [os.open(__file__, 0)])",
        "lock memory": "import mmap; kept = mmap.mmap(-1, 1 << 20); return 1 + call(149, 228, ctypes.c_void_p(ctypes.addressof(ctypes.c_char.from_buffer(kept))), ctypes.c_size_t(1 << 20))",
        "use large pages again": "return 1 + call(157, 167, 41, 0, 0, 0, 0)",
    },
}  # fmt: skip
"""By the key of the promise that each attack would break, if it worked; all of them hold from level 1 on."""

ATTACKS = {name: body for attacks in ATTACKS_BY_PROMISE.values() for name, body in attacks.items()}

HEAD = """
import ctypes, os
_libc = ctypes.CDLL(None, use_errno=True)

def call(x86, arm, *arguments):
    number = x86 if os.uname().machine == "x86_64" else arm
    result = _libc.syscall(ctypes.c_long(number), *arguments)
    if result < 0:
        raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()))
    return result
"""


COUNTED = [Level.ANOTHER_USER] if os.geteuid() == 0 else [Level.FILTERED, Level.SEPARATE]
"""The levels on which the kernel counts a program's threads: it never counts root's."""


def _attack_file(student: Student) -> Path:
    source = HEAD
    for i, body in enumerate(ATTACKS.values()):
        source += f"\ndef attack{i}(secret, grader):\n    try:\n        {body}\n    except (OSError, ValueError): return 0\n"
    return student(source)


@pytest.mark.long_cases("L1")
def test_no_attack_gets_anywhere(student: Student, tmp_path: Path, level: Level) -> None:
    secret = tmp_path / "hidden" / "solution.txt"
    secret.parent.mkdir()
    secret.write_text("forty-two")
    record = {"secret": str(secret), "grader": os.getpid()}
    file = _attack_file(student)
    with StudentFunctions(file, limits=QUICK, level=level) as functions:
        assert functions.level is level
        gained = [
            name for i, name in enumerate(ATTACKS) if functions.call_batch(f"attack{i}", [record]) != [0.0]
        ]
    assert gained == []
    assert secret.read_text() == "forty-two"
    assert sorted(path.name for path in secret.parent.iterdir()) == ["solution.txt"]
    assert sorted(path.name for path in file.parent.iterdir()) == ["work.py"]


@pytest.mark.long
@LINUX
def test_without_confinement_the_attacks_do_work(student: Student, tmp_path: Path) -> None:
    """So the test above does not pass because the attacks are clumsy. Harmless ones only."""
    secret = tmp_path / "solution.txt"
    secret.write_text("forty-two")
    harmless = (
        "read a file outside", "list a folder outside", "read through a link", "write a file outside",
        "make a file outside", "change its own source", "change a file's rights", "change a file's time",
        "start a program", "spawn a program", "vfork past the library", "send over UDP", "open a local socket",
        "signal the process above", "signal the grader", "signal its group", "signal by descriptor",
        "read the grader's environment", "read the grader's arguments", "open the grader's files",
        "use shared memory", "use memory that nobody counts", "hold back whoever opens a file",
        "watch what others open", "have the grader signalled by a pipe", "have the grader signalled by a socket",
        "choose the signal of a pipe", "live on after the kit", "use up the machine's requests",
        "use up its user's signals", "leave pages in a pipe", "copy a pipe's pages", "move pages into a pipe",
        "widen a pipe", "leave a hint with a file", "read an attribute outside", "reserve the disk beyond every limit", "send a file that nobody sees", "lock memory",
        "use large pages again",
    )  # fmt: skip
    record = {"secret": str(secret), "grader": os.getpid()}
    names = list(ATTACKS)
    for name in harmless:
        if name == "vfork past the library":
            continue  # would go on with the parent's stack
        with StudentFunctions(_attack_file(student), limits=QUICK) as functions:
            assert functions.call_batch(f"attack{names.index(name)}", [record]) != [0.0], name


def test_honest_work_goes_on(student: Student, level: Level) -> None:
    student("FACTOR = 3", "friend.py")
    student("2.5", "numbers.txt")
    file = student(
        """
        import asyncio, datetime, os, random, tempfile, threading
        import friend

        def reads_its_folder():
            return friend.FACTOR * float(open(os.path.dirname(__file__) + "/numbers.txt").read())

        def writes():
            with open("log.txt", "w") as log: log.write("x" * 1000)
            os.mkdir("d"); os.rename("log.txt", "d/log.txt"); os.remove("d/log.txt"); os.rmdir("d")
            with tempfile.TemporaryFile() as file: file.write(b"y")
            with open(os.devnull, "w") as null: null.write("z")
            return len(os.listdir())

        def threads():
            found = []
            workers = [threading.Thread(target=found.append, args=(i,)) for i in range(4)]
            for worker in workers: worker.start()
            for worker in workers: worker.join()
            return len(found)

        def waits():
            async def soon():
                await asyncio.sleep(0.01)
                return 1
            return asyncio.run(soon())

        def numbers():
            import numpy
            a = numpy.ones((64, 64))
            return float((a @ a).sum())

        def chance():
            return len(os.urandom(4)) + random.SystemRandom().random() * 0 + datetime.datetime.now().year * 0
        """
    )
    with StudentFunctions(file, limits=QUICK, level=level) as functions:
        results = {name: functions.call_batch(name, [{}]) for name in functions.names}
    assert results == {
        "reads_its_folder": [7.5],
        "writes": [0.0],
        "threads": [4.0],
        "waits": [1.0],
        "numbers": [64.0**3],
        "chance": [4.0],
    }


def test_a_controller_runs_on_every_level(student: Student, level: Level) -> None:
    avoid = find_controller("avoid").file
    graph = Graph()
    commands: list[Twist] = []
    node = create_graph_node(graph, "world")
    node.create_subscription(Twist, "cmd_vel", commands.append, 10)
    scans = node.create_publisher(LaserScan, "static_laser", 10)
    with NodeProcess.start(graph, avoid, limits=QUICK, level=level) as process:
        scans.publish(LaserScan(ranges=array("f", [3.0] * 91)))
        while graph.run_due() or process.exchange():
            pass
        assert process.failure is None
        assert [command.linear.x for command in commands] == [1.0]


@pytest.mark.long
def test_every_failure_is_still_told(student: Student, level: Level) -> None:
    cases = {
        "return 1 / 0": (FailureKind.EXCEPTION, 2),
        "open('/etc/passwd')": (FailureKind.EXCEPTION, 2),
        "while True: pass": (FailureKind.TIMEOUT, 2),
        "x = bytearray(10**11)": (FailureKind.MEMORY, 2),
        "import os; os.abort()": (FailureKind.CRASH, 2),
        "import os; os._exit(0)": (FailureKind.EXIT, None),
    }
    limits = dataclasses.replace(QUICK, reply_s=0.5)
    for body, expected in cases.items():
        with StudentFunctions(student(f"def f():\n    {body}"), limits=limits, level=level) as functions:
            with pytest.raises(StudentCodeError) as caught:
                functions.call_batch("f", [{}])
            assert (caught.value.failure.kind, caught.value.failure.line) == expected, body


@pytest.mark.long
def test_processor_time_runs_out_when_confined_too(student: Student, level: Level) -> None:
    limits = dataclasses.replace(QUICK, cpu_s=1, reply_s=20.0)
    with StudentFunctions(student("def f():\n    while True: pass"), limits=limits, level=level) as functions:
        with pytest.raises(StudentCodeError, match="processor time") as caught:
            functions.call_batch("f", [{}])
        assert caught.value.failure.kind is FailureKind.TIMEOUT


@pytest.mark.parametrize("level", [Level.SEPARATE, Level.ANOTHER_USER], ids=["L2", "L3"], indirect=True)
def test_a_separate_program_is_alone_and_its_disk_is_small(student: Student, level: Level) -> None:
    file = student(
        """
        import errno, os
        def alone():
            assert os.getpid() == 2 and os.getppid() == 1
            places = ("/etc/passwd", "/home", "/proc/1", "/bin/sh", "/dev/shm")
            return sum(os.path.exists(each) for each in places if not __file__.startswith(each))
        def fill():
            try:
                for i in range(100):
                    with open(f"file{i}", "wb") as out: out.write(bytes(2**20))
            except OSError as full:
                assert full.errno == errno.ENOSPC
                return i
        """
    )
    limits = dataclasses.replace(QUICK, scratch=8 * MIB, reply_s=10)
    with StudentFunctions(file, limits=limits, level=level) as functions:
        assert functions.call_batch("alone", [{}]) == [0.0]
        (written,) = functions.call_batch("fill", [{}])
        assert 5 <= written <= 8


@pytest.mark.parametrize("level", [Level.FILTERED, Level.SEPARATE], ids=["L1", "L2"], indirect=True)
def test_a_file_that_lies_beside_the_runs_own_folders(
    tmp_path: Path, level: Level, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    file = tmp_path / "work.py"
    file.write_text("def f():\n    open('x', 'w').write('y')\n    return 1")
    with StudentFunctions(file, limits=QUICK, level=level) as functions:
        assert functions.call_batch("f", [{}]) == [1.0]
    assert [path.name for path in tmp_path.iterdir()] == ["work.py"]


@pytest.mark.parametrize("level", [Level.ANOTHER_USER], ids=["L3"], indirect=True)
def test_two_runs_have_two_users(student: Student, level: Level) -> None:
    file = student("import os\ndef user(): return os.getuid() + 0.5 * (os.getgid() != os.getuid())")
    with (
        StudentFunctions(file, limits=QUICK, level=level) as first,
        StudentFunctions(file, limits=QUICK, level=level) as second,
    ):
        users = {functions.call_batch("user", [{}])[0] for functions in (first, second)}
    assert len(users) == 2
    assert min(users) >= 1_500_000_000


@LINUX
@pytest.mark.parametrize("level", COUNTED, ids=str, indirect=True)
def test_threads_are_counted(student: Student, level: Level) -> None:
    source = """
        import threading, time
        def f():
            for i in range(1000):
                threading.Thread(target=time.sleep, args=(5,), daemon=True).start()
        """
    limits = dataclasses.replace(QUICK, processes=16, memory=4096 * MIB)
    with (
        StudentFunctions(student(source), limits=limits, level=level) as functions,
        pytest.raises(StudentCodeError, match="can't start new thread"),
    ):
        functions.call_batch("f", [{}])


@LINUX
def test_no_program_of_the_machines_gets_the_memory_of_one_that_crashes(student: Student) -> None:
    """As those do to which Linux pipes cores, whatever the limit is, unless it is 1."""
    file = student("import resource\ndef f(): return resource.getrlimit(resource.RLIMIT_CORE)\n")
    with StudentFunctions(file, limits=QUICK, level=Level.LIMITED) as functions:
        allowed = resource.getrlimit(resource.RLIMIT_CORE)[1]
        assert functions.call_json("f", {}) == ([0.0, 0.0] if allowed == 0 else [1.0, 1.0])


def test_the_probe_says_what_is_missing() -> None:
    supports = _supports()
    assert [support.level for support in supports] == list(Level)
    assert supports[0].is_available
    assert all(support.reason for support in supports)
    assert highest_level_up_to(Level.ANOTHER_USER) == max(
        support.level for support in supports if support.is_available
    )


@pytest.mark.long
@LINUX
@pytest.mark.skipif(os.geteuid() != 0, reason="only root can try it as somebody else")
def test_without_rights_the_levels_end_where_they_are_needed(student: Student) -> None:
    """As nobody: Landlock and seccomp still hold; a user for each run cannot be had, and why."""
    attack = student("def f(path):\n    try: return len(open(path).read())\n    except OSError: return 0")
    script = f"""
        import sys; sys.path.insert(0, {str(Path(__file__).parents[3])!r})
        from pathlib import Path
        from kit.host.student_functions import StudentFunctions
        from kit.host.sandbox.sandbox_config import Level
        from kit.host.sandbox.probe import probe_levels
        for support in probe_levels(): print(support.level.value, support.is_available, support.reason)
        for level in (Level.LIMITED, Level.FILTERED):
            with StudentFunctions(Path({str(attack)!r}), level=level) as functions:
                print(level.value, functions.call_batch("f", [{{"path": "/etc/passwd"}}])[0] > 0)
        """
    for folder in above(attack):
        folder.chmod(0o755)
    python = "/usr/bin/python3"
    trial = [python, "-c", "import sys; sys.exit(sys.version_info < (3, 11))"]
    if not Path(python).exists() or subprocess.run(trial, user=65534, check=False).returncode:
        pytest.skip(f"{python} is not there, or too old; nobody cannot read root's")
    run = subprocess.run(
        [python, "-B", "-c", textwrap.dedent(script)],
        user=65534, group=65534, extra_groups=[], env={"TMPDIR": "/tmp"}, cwd="/",
        capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    lines = run.stdout.splitlines()
    assert run.returncode == 0, run.stderr
    assert lines[3].startswith("3 False")
    assert "needs root" in lines[3]
    assert lines[-2:] == ["0 True", "1 False"]


SHIELD = """
import sys, os
sys.path.insert(0, {root!r})
from pathlib import Path
from kit.host.student_functions import StudentFunctions
from kit.host.sandbox.process_control import shield_this_process
shield_this_process()
with StudentFunctions(Path({file!r})) as functions:
    print(functions.call_batch("f", [{{"grader": os.getpid()}}]))
"""


@LINUX
@pytest.mark.skipif(os.geteuid() != 0, reason="needs to become nobody; as nobody there is nothing to become")
def test_a_shielded_grader_keeps_its_secrets_even_without_confinement(student: Student) -> None:
    file = student(
        """
        def f(grader):
            seen = 0
            for name in ("environ", "maps", "mem"):
                try:
                    with open(f"/proc/{grader}/{name}", "rb") as opened: seen += 1
                except OSError: pass
            return seen
        """
    )
    for folder in above(file):
        folder.chmod(0o755)
    python = "/usr/bin/python3"
    if not Path(python).is_file():
        pytest.skip("no Python that another user may run")
    code = SHIELD.format(root=str(Path(__file__).parents[3]), file=str(file))
    for expected, script in (("[0.0]", code), ("[3.0]", code.replace("\nshield_this_process()", ""))):
        run = subprocess.run(
            [python, "-B", "-c", script],
            user=65534, group=65534, extra_groups=[], env={"TMPDIR": "/tmp"}, cwd="/",
            capture_output=True, text=True, timeout=60, check=False,
        )  # fmt: skip
        if run.returncode and "PermissionError" in run.stderr:
            pytest.skip("nobody cannot read this checkout or Python")
        assert run.stdout.strip() == expected, run.stderr


def test_a_level_that_cannot_be_had_is_refused(student: Student, monkeypatch: pytest.MonkeyPatch) -> None:
    missing = [support for support in _supports() if not support.is_available]
    if not missing:
        pytest.skip("this machine allows every level")
    with pytest.raises(StudentCodeError) as caught:
        StudentFunctions(student("def f(): return 1"), level=missing[0].level)
    assert caught.value.failure.kind is FailureKind.CONFINEMENT


@pytest.mark.parametrize("machine", seccomp.ARCHITECTURES)
def test_the_filter_decides_each_call_rightly(machine: str) -> None:
    """Runs the filter's own instructions over calls of both architectures."""
    architecture = seccomp.ARCHITECTURES[machine]
    column = architecture.column
    code = seccomp.program(architecture, own_process=4711)
    allow, kill, refused = 0x7FFF0000, 0x80000000, 0x00050001

    def decide(number: int | None, *arguments: int, audit: int = architecture.audit) -> int:
        assert number is not None
        return _interpret(code, number, audit, arguments)

    checked = seccomp.checked_calls(4711)
    clone, socketpair = ((56, 220)[column], (53, 199)[column])
    for table, decision in ((seccomp.ALLOWED, allow), (seccomp.DENIED, refused)):
        for name, numbers in table.items():
            if numbers[column] is not None:
                assert decide(numbers[column]) == decision, name
    clone3, newest, not_in_any_table = 435, 462, 500
    for number in (clone3, newest, not_in_any_table, 0x40000000 + 39):
        assert decide(number) == 0x00050026, "as on a kernel that does not have it"
    assert decide(clone, 0x003D0F00) == allow  # what a new thread asks for
    assert decide(clone, 0x01200011) == refused  # what fork() asks for
    for name, good, bad in (
        ("kill", (4711,), (4712,)),
        ("kill", (4711,), (2**32 - 1,)),
        ("tgkill", (4711,), (1,)),
        ("prlimit64", (0,), (1,)),
        ("prlimit64", (4711,), (4712,)),
        ("prlimit64", (0, 9), (0, 4)),
        ("setrlimit", (9,), (4,)),
        ("ioctl", (3, 0x5401), (3, 0x40086602)),
        ("ioctl", (3, 0x541B), (3, 0x8902)),
        ("fcntl", (3, 1030), (3, 1031)),
        ("fcntl", (3, 6), (3, 8)),
        ("madvise", (0, 0, 4), (0, 0, 21)),
        ("fadvise64", (3, 0, 0, 3), (3, 0, 0, 4)),
        ("fallocate", (3, 0, 0, 9), (3, 1, 0, 9)),
        ("preadv2", (3, 0, 1, 0, 0, 0), (3, 0, 1, 0, 0, 8)),
        ("prctl", (15,), (1,)),
        ("prctl", (15,), (41,)),
    ):
        assert decide(checked[name].numbers[column], *good) == allow, name
        assert decide(checked[name].numbers[column], *bad) == refused, name
    for flags in (0, socket.SOCK_CLOEXEC, socket.SOCK_NONBLOCK, socket.SOCK_CLOEXEC | socket.SOCK_NONBLOCK):
        assert decide(socketpair, socket.AF_UNIX, socket.SOCK_STREAM | flags) == allow
        for kind in (socket.SOCK_DGRAM, socket.SOCK_RAW, socket.SOCK_SEQPACKET):
            assert decide(socketpair, socket.AF_UNIX, kind | flags) == 0x00050001
    assert decide(socketpair, 30, socket.SOCK_STREAM) == 0x00050001  # AF_TIPC
    read, mmap = {"x86_64": (0, 9), "aarch64": (63, 222)}[machine]
    assert decide(read) == decide(mmap) == allow
    assert decide(read, audit=0x40000003) == kill


@pytest.mark.parametrize("machine", seccomp.ARCHITECTURES)
def test_no_call_is_in_two_tables(machine: str) -> None:
    column = seccomp.ARCHITECTURES[machine].column
    tables = (
        seccomp.ALLOWED,
        seccomp.DENIED,
        {each: c.numbers for each, c in seccomp.checked_calls(1).items()},
    )
    numbers = [call[column] for table in tables for call in table.values() if call[column] is not None]
    assert len(numbers) == len(set(numbers))


@LINUX
@pytest.mark.parametrize(
    ("body", "called"),
    [
        ("os.fork()", "os.fork()"),
        ("subprocess.run(['true'])", "_fork_exec()"),
        ("socket.socket()", "_socket.socket.__init__()"),
        ("os.chmod('x', 0)", "os.chmod()"),
    ],
)
def test_a_refused_call_is_named(body: str, called: str, student: Student) -> None:
    file = student(f"import os, socket, subprocess\ndef f():\n    {body}\n")
    with (
        StudentFunctions(file, limits=QUICK, level=Level.FILTERED) as functions,
        pytest.raises(StudentCodeError) as caught,
    ):
        functions.call_json("f", {})
    assert f". {called} is refused to a program that is confined" in caught.value.failure.message


def _interpret(code: bytes, number: int, audit: int, arguments: Sequence[int]) -> int:
    """Classic BPF, as far as the filter uses it."""
    data = struct.pack("<IIQ6Q", number, audit, 0, *arguments, *[0] * (6 - len(arguments)))
    instructions = list(struct.iter_unpack("=HBBI", code))
    accumulator = at = 0
    while True:
        operation, yes, no, operand = instructions[at]
        at += 1
        if operation == 0x20:
            (accumulator,) = struct.unpack_from("<I", data, operand)
        elif operation == 0x06:
            return int(operand)
        else:
            tests = {
                0x15: accumulator == operand,
                0x25: accumulator > operand,
                0x45: bool(accumulator & operand),
            }
            at += yes if tests[operation] else no


@pytest.mark.leans_on_clock("it compares how long two starts take")
@pytest.mark.long
@LINUX
def test_confinement_costs_little_time(student: Student) -> None:
    """Level 1 adds less than 20 ms to a start; measured as the best of several, and with room to spare."""
    if landlock.abi() == 0:
        pytest.skip("no Landlock")

    def best(level: Level) -> float:
        times = []
        for _ in range(5):
            began = time.perf_counter()
            functions = StudentFunctions(file, limits=QUICK, level=level)
            times.append(time.perf_counter() - began)
            functions.close()
        return min(times)

    file = student("")
    assert best(Level.FILTERED) - best(Level.LIMITED) < 0.12


@pytest.mark.parametrize(
    "hide",
    [
        "kept.append(mmap.mmap(file.fileno(), 4096))",
        "kept.append(os.dup(file.fileno()))",
    ],
    ids=["mapped", "duplicated"],
)
def test_files_that_nobody_sees_are_limited_too(hide: str, student: Student, level: Level) -> None:
    """Unlinked, closed, and kept by something else: no list of a process's files shows them all."""
    if level is Level.FILTERED and not can_mount_scratch():
        pytest.skip("at level 1 this machine only measures")
    file = student(
        f"""
        import mmap, os
        kept = []
        def fill():
            written = 0
            try:
                while written < 40:
                    with open("x", "w+b") as file:
                        file.write(bytes(1 << 20)); file.flush()
                        {hide}
                        os.unlink("x")
                    written += 1
            except OSError: pass
            return written
        """
    )
    limits = dataclasses.replace(QUICK, scratch=8 * MIB, open_files=200)
    with StudentFunctions(file, limits=limits, level=level) as functions:
        assert functions.call_batch("fill", [{}])[0] <= 8


def test_an_own_disk_at_level_1_is_gone_with_its_processes(student: Student, tmp_path: Path) -> None:
    if not can_mount_scratch():
        pytest.skip("this machine allows no mounts")
    with StudentFunctions(student("def f(): return 1"), limits=QUICK, level=Level.FILTERED) as functions:
        mounts = Path(f"/proc/{functions._process.pid}/mounts").read_text()
        assert "/scratch tmpfs" in mounts
        assert "/scratch tmpfs" not in Path("/proc/self/mounts").read_text(), "only its processes see it"
