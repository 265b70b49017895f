"""Attacks of kinds that the catalogue of ``attacks`` does not hold: descriptors, other people's work, archives of every
sort, worlds, answers, functions, limits that only the process of the kit can keep."""

from __future__ import annotations

import io
import json
import os
import stat
import subprocess
import sys
import tarfile
import unicodedata
import warnings
import zipfile
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from pathlib import Path, PureWindowsPath
from typing import Any

import numpy as np
import pytest
import yaml
from PIL import Image

from grader.assignment import Assignment
from grader.evidence.reader_process import MEMORY_LIMIT
from kit.host import process
from kit.host.sandbox.limits import GIB, GRADER_LIMITS
from kit.host.sandbox.sandbox_config import Level
from kit.host.wire import OVER_DISK_LIMIT
from kit.learning.environment.batch import BatchEnv
from kit.learning.maps.batch_floor import FLOOR_CELL
from kit.learning.tasks.task_spec import TaskSpec
from kit.render import raster
from kit.results.grading_result import GradingVerdict
from tests.grader.attack import (
    HARMLESS,
    HASTY,
    LARGE,
    ODD,
    RAN,
    REFUSED,
    SLOW,
    STOPPED,
    Attack,
    End,
    attempt,
    write_tar,
    write_zip,
)  # fmt: skip

MAX_SMALL: int = 1 << 20
"""Bytes that an archive or a picture may have for its size to be a surprise."""

WORLD_SHEET = """
title: A world
kind: world
submit: world.yaml
checks: [{check: loads, points: 10}]
"""
ANSWERS_SHEET = """
title: Answers
kind: answers
submit: answers.yaml
questions:
  turn: {ask: Which way?, choices: [left, right]}
  speed: {ask: How fast?}
answers: {turn: {right: [left]}, speed: {right: [0.5], within: 0.1}}
checks: [{check: answers, points: 10}]
"""
FUNCTION_SHEET = """
title: Halve
kind: function
submit: work.py
functions: [{name: half}]
checks: [{check: agrees, points: 10}]
"""
PATIENT = "budget: {reply: 60, total: 60}\n"
"""For what takes a second of processor time, on a machine with much else to do."""
TASK_SHEET = """
title: A task
kind: task
submit: task.yaml
task: {algorithm: q-learning, steps: 1000, trainings: 1, episodes: 10, policy: best.npz}
budget: {start: 60, reply: 60, total: 120}
checks:
  - {check: sound, points: 1}
  - {check: loops, points: 4, after: sound}
  - {check: learns, points: 4, after: loops}
  - {check: arrives, points: 1, after: sound}
"""
REFERENCE = {
    "reference.py": b"def half(x): return x / 2\ndef half_cases(random): yield {'x': random.random()}\n"
}

WORLD = """
properties: {}
layers: [{name: [solid], map: room.yaml}]
models: [{name: robot, model: robot.model.yaml, pose: [1, 1, 0]}]
"""
ROOM = b"type: line_segments\ndata: room.dat\nscale: 1\norigin: [0, 0, 0]\n"
ROBOT = "bodies: [{name: base, footprints: [{type: circle, radius: RADIUS, density: 1, layers: [solid]}]}]\n"
ROBOT_WITH_LASER = (
    ROBOT.replace("RADIUS", "0.1")
    + "plugins:\n"
    + "  - {type: DiffDrive, name: drive, body: base}\n"
    + "  - {type: Laser, name: lidar, body: base, range: 10, layers: [solid],\n"
    + "     angle: {min: -3.14159265359, max: 3.14159265359, increment: 0.06981317007}}\n"
)
SQUARE = b"0 0 4 0\n4 0 4 4\n4 4 0 4\n0 4 0 0\n"
UNREAD = End(0.0, "fail")


def world_files(**changed: bytes) -> dict[str, bytes]:
    """The files beside ``WORLD``; keywords: other contents, by the name without its ending."""
    files = {
        "room.yaml": ROOM,
        "room.dat": SQUARE,
        "robot.model.yaml": ROBOT.replace("RADIUS", "0.2").encode(),
    }
    names = {"room": "room.yaml", "dat": "room.dat", "robot": "robot.model.yaml", "picture": "picture.png"}
    return files | {names[name]: content for name, content in changed.items()}


TASK = """
summary: In a room
world: world.yaml
robots: [robot]
cases: [{name: on, start: [0.5, 0.5, 0], target: [0.8, 0.5]}]
actions: {twists: {back: [-0.3, 0], forward: [0.3, 0]}}
observation: {sectors: 1}
reward: {terms: {progress: 1.0}}
"""
"""Handed in with the files of ``task_files``."""
ENDLESS = TASK + "step: {time: 10, limit: 100000, collision_checks: 100}\nendings: {collision: continues}\n"
BIG_SQUARE = SQUARE.replace(b"4", b"5000")


def task_files(**changed: bytes) -> dict[str, bytes]:
    """The files beside ``TASK``."""
    robot = ROBOT_WITH_LASER.encode()
    return {"world.yaml": WORLD.encode(), **world_files(**({"robot": robot} | changed))}


def picture_bomb() -> bytes:
    """A picture of 36 million pixels in a few kilobytes."""
    out = io.BytesIO()
    Image.new("1", (6_000, 6_000), 1).save(out, "PNG")
    return out.getvalue()


PICTURE_ROOM = b"image: picture.png\nresolution: 0.05\norigin: [0, 0, 0]\noccupied_thresh: 0.65\nfree_thresh: 0.196\nnegate: 0\n"
ALIASES = "a: &a [x, x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"{new}: &{new} [{', '.join([f'*{old}'] * 10)}]\n" for old, new in zip("abcdef", "bcdefg", strict=True)
)
"""Seven lines of YAML that stand for ten million words."""


DATAGRAM = """
import socket
ours, _ = socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)
try: ours.sendto(b"letter", "/nobody/listens/here")
except FileNotFoundError: got("looked for the receiver")
"""
"""Sends to a socket of another process by its name; that there is none of this name is found out by looking."""


# Controls: does it work on somebody without the defence?


def leaves_by_its_name(name: str) -> Callable[[Path], bool]:
    """Joining the name to a folder leads out of that folder."""
    return lambda folder: not os.path.normpath(folder / "in" / name).startswith(f"{folder}/in")


def keeps_python_from_ending(body: str) -> Callable[[Path], bool]:
    """An interpreter of its own does not come to an end with this body."""

    def control(folder: Path) -> bool:
        with pytest.raises(subprocess.TimeoutExpired):
            subprocess.run([sys.executable, "-c", body], timeout=1, check=False)
        return True

    return control


def unpack_carelessly(archive: Path, out: Path) -> None:
    """Extracts a tar archive as Python did before it looked at what is in one; early 3.11 still does, and knows no filter."""
    with tarfile.open(archive) as opened:
        opened.extraction_filter = lambda member, path: member
        opened.extractall(out)


def extracts_to(
    pack: Callable[[Path], None], name: str, is_it: Callable[[Path], bool]
) -> Callable[[Path], bool]:
    """The standard library's own extraction, told to trust the archive, makes a file of which ``is_it`` is true."""

    def control(folder: Path) -> bool:
        pack(folder / "handed")
        (archive,) = folder.iterdir()
        out = folder / "out"
        if archive.suffix == ".tar":
            unpack_carelessly(archive, out)
        else:
            with zipfile.ZipFile(archive) as packed:
                packed.extractall(out)
        return is_it(out / name)

    return control


def fails_to_extract(pack: Callable[[Path], None]) -> Callable[[Path], bool]:
    """The standard library's own extraction ends with an error in the middle."""

    def control(folder: Path) -> bool:
        pack(folder / "handed")
        with (
            zipfile.ZipFile(folder / "handed.zip") as packed,
            suppress(OSError, RuntimeError, zipfile.BadZipFile),
        ):
            packed.extractall(folder / "out")
            return False
        return True

    return control


def loads_for_ever_more(folder: Path) -> bool:
    """PyYAML takes the seven lines, and what they stand for has ten million words."""
    content = yaml.safe_load(ALIASES)

    def count(value: Any, known: dict[int, int]) -> int:
        if not isinstance(value, list):
            return 1
        if id(value) not in known:
            known[id(value)] = sum(count(each, known) for each in value)
        return known[id(value)]

    return count(content["g"], {}) == 10_000_000


def cannot_be_drawn(folder: Path) -> bool:
    """A picture with a rim as wide as the robot takes more memory than there is."""
    with pytest.raises((ValueError, MemoryError)):
        raster.empty_grid(10**12, 10**12)
    return True


# Archives


def zip_of(*entries: tuple[str, bytes]) -> Callable[[Path], None]:
    """Packs entries, also of the same name, with names as they are."""

    def pack(path: Path) -> None:
        with zipfile.ZipFile(path.with_suffix(".zip"), "w") as archive, warnings.catch_warnings():
            warnings.simplefilter("ignore")  # it warns of two entries of one name, which is what is wanted
            for name, content in entries:
                entry = zipfile.ZipInfo("x")
                entry.filename = entry.orig_filename = name
                entry.compress_type = zipfile.ZIP_DEFLATED
                archive.writestr(entry, content)

    return pack


def tar_of(name: str, kind: bytes, link: str = "") -> Callable[[Path], None]:
    return lambda path: write_tar(path.with_suffix(".tar"), name, kind, link)


def tar_that_renames(path: Path) -> None:
    """A header that a newer one follows: the name in the older header is harmless."""
    with tarfile.open(path.with_suffix(".tar"), "w", format=tarfile.PAX_FORMAT) as archive:
        entry = tarfile.TarInfo("controller.py")
        entry.pax_headers = {"path": "../../evil.py"}
        archive.addfile(entry, io.BytesIO())


def locked_zip(path: Path) -> None:
    zip_of(("controller.py", b"x"))(path)
    archive = path.with_suffix(".zip")
    content = bytearray(archive.read_bytes())
    content[6] |= 1
    content[content.index(b"PK\x01\x02") + 8] |= 1
    archive.write_bytes(content)


def overlapping_zip(path: Path) -> None:
    """A hundred names for one and the same compressed megabyte."""
    archive = path.with_suffix(".zip")
    zip_of(("controller.py", HARMLESS.encode()), ("f000.txt", bytes(1 << 20)))(path)
    content = archive.read_bytes()
    directory = content.index(b"PK\x01\x02")
    end = content.index(b"PK\x05\x06")
    last = content.rindex(b"PK\x01\x02")
    copies = b"".join(content[last:end].replace(b"f000", b"f%03d" % number) for number in range(1, 100))
    tail = bytearray(content[end:])
    tail[8:10] = tail[10:12] = (102 - 1).to_bytes(2, "little")
    tail[12:16] = (end - directory + len(copies)).to_bytes(4, "little")
    archive.write_bytes(content[:end] + copies + bytes(tail))


def promises_far_more(folder: Path) -> bool:
    overlapping_zip(folder / "handed")
    archive = folder / "handed.zip"
    with zipfile.ZipFile(archive) as packed:
        return sum(each.file_size for each in packed.infolist()) > 1000 * archive.stat().st_size


def linked_folder(path: Path) -> None:
    path.mkdir()
    (path / "controller.py").write_text(HARMLESS)
    (path / "data").symlink_to("/etc")


def waiting_pipe(path: Path) -> None:
    path.mkdir()
    os.mkfifo(path / "controller.py")


def is_pipe(folder: Path) -> bool:
    waiting_pipe(folder / "handed")
    return stat.S_ISFIFO((folder / "handed" / "controller.py").stat().st_mode)


def linked_passwords(folder: Path) -> bool:
    linked_folder(folder / "handed")
    return (folder / "handed" / "data" / "passwd").is_file()


TWICE = zip_of(("controller.py", b"raise SystemExit"), ("controller.py", HARMLESS.encode()))
BOTH = zip_of(("controller.py", HARMLESS.encode()), ("x", b"1"), ("x/y.py", b"2"))


def linking_zip(path: Path) -> None:
    write_zip(path.with_suffix(".zip"), {"d": b"/tmp", "controller.py": b"/etc/passwd"}, mode=0o120777)


def marked_carelessly(answers: str, right: str | float) -> bool:
    """A marker that looks for the right word among those given, and refuses numbers that are too far off."""
    (given,) = yaml.safe_load(answers).values()
    return not abs(given - right) > 0.1 if isinstance(right, float) else right in given


def hard_links(folder: Path) -> bool:
    secret = folder / "secret"
    secret.write_text("forty-two")
    write_tar(folder / "handed.tar", "controller.py", tarfile.LNKTYPE, str(secret))
    unpack_carelessly(folder / "handed.tar", folder / "out")
    return (folder / "out" / "controller.py").samefile(secret)


def renames(folder: Path) -> bool:
    tar_that_renames(folder / "handed")
    with tarfile.open(folder / "handed.tar") as archive:
        return archive.getnames() == ["../../evil.py"]


def too_deep(folder: Path) -> bool:
    """Folders that are made one by one, as an extraction does, end in an error."""
    with pytest.raises(OSError, match="File name too long"):
        Path(folder, "a/" * 4200).mkdir(parents=True)
    return True


def equals_everything(folder: Path) -> bool:
    class All:
        def __eq__(self, other: object) -> bool:
            return True

        __hash__ = None  # type: ignore[assignment]  # as in the attack

    return All() == 5 and All() == "x"


def number_equals_everything(folder: Path) -> bool:
    class Number(float):
        def __eq__(self, other: object) -> bool:
            return True

        __hash__ = None  # type: ignore[assignment]  # as in the attack

    return Number(1.0) == 0.5


def has_no_words(folder: Path) -> bool:
    class Mute(Exception):
        def __str__(self) -> str:
            raise SystemExit

    with pytest.raises(SystemExit):
        str(Mute())
    return True


def no_number(folder: Path) -> bool:
    """Python refuses to read so long a number, by an error that nobody expects who has matched its digits."""
    with pytest.raises(ValueError, match="Exceeds the limit"):
        int("9" * 5000)
    return True


DUMP = """
lines = ["Current thread 0x1 (most recent call first):", f'  File "{__file__}", line {"9" * 5000} in attack']
os.write(2, ("\\n".join(lines) + "\\n").encode())
os._exit(1)
"""
WRITE_FRAME = (
    "import json, os, stat, struct\n"
    "data = json.dumps(FRAME).encode()\n"
    "for fd in range(3, 64):\n"
    "    try:\n"
    "        if stat.S_ISSOCK(os.fstat(fd).st_mode): os.write(fd, struct.pack('>I', len(data)) + data)\n"
    "    except OSError: pass\n"
    "while True: os.sched_yield()\n"
)


def without(**limits: int | None) -> Callable[[Assignment], Assignment]:
    """The assignment with other limits."""
    changed: dict[str, Any] = limits
    return lambda assignment: replace(assignment, limits=replace(assignment.limits, **changed))


def outlasts(name: str, larger: int) -> Callable[[Path], bool]:
    """A file of the grader's limit and more can be made where nothing limits it."""

    def control(folder: Path) -> bool:
        with Path(folder, name).open("wb") as file:
            file.truncate(larger)
        return (folder / name).stat().st_size > GRADER_LIMITS.file_size

    return control


LIBC = "import ctypes; libc = ctypes.CDLL(None, use_errno=True)\n"
LOCAL = "own = open(__file__)\n"
LATE = "import select\nclass Late:\n    def __del__(self, wait=select.select): wait([], [], [], 1000)\nlate = Late()\n"
WAIT = "import select; select.select([], [], [], 1)"
LATCHED = (
    "from rclpy.qos import QoSProfile, DurabilityPolicy\nfrom std_msgs.msg import String\n"
    "kept = node.create_publisher(String, 'kept', QoSProfile(depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL))\n"
    "node.create_timer(0.01, lambda: [kept.publish(String(data='x' * 30000)) for _ in range(30)])"
)


def believes_every_frame(attack_name: str) -> Callable[[Path], bool]:
    """A kit that takes every frame in every state has the same program judged as a fault of the machine's."""

    def control(folder: Path) -> bool:
        attack = next(each for each in FURTHER_ATTACKS if each.name == attack_name)
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(process, "check_allowed", lambda frame, state: None)
            outcome = attempt(attack, Level.FILTERED, folder)
        return outcome.result is not None and outcome.result.verdict is GradingVerdict.BROKEN

    return control


def ends_with(code: int, body: str) -> Callable[[Path], bool]:
    """Any process may end like this."""
    return lambda folder: subprocess.run([sys.executable, "-c", body], check=False).returncode == code


def never_ends(folder: Path) -> bool:
    """Whether the episodes of ``ENDLESS`` go on, though the robot drives against a wall."""
    for name, content in {"task.yaml": ENDLESS.encode(), **task_files()}.items():
        (folder / name).write_bytes(content)
    batch = BatchEnv(TaskSpec(str(folder / "task.yaml")).resolve(), 2, 1, autoreset=False)
    batch.reset()
    return not any(batch.step(np.array([0, 0])).ended.any() for _ in range(5))


def never_ends_when_stopped(folder: Path) -> bool:
    """Whether a process that has stopped itself still lives, and waits for ever."""
    stops = [sys.executable, "-c", "import os, signal; os.kill(os.getpid(), signal.SIGSTOP)"]
    with subprocess.Popen(stops) as running:
        _, status = os.waitpid(running.pid, os.WUNTRACED)
        is_stopped = os.WIFSTOPPED(status)
        running.kill()
    return is_stopped


def policy_that_runs(file: Path) -> bytes:
    """An array of objects, one of which makes ``file`` as soon as it is unpickled."""

    class Runs:
        def __reduce__(self) -> tuple[Callable[[str], None], tuple[str]]:
            return os.mkdir, (str(file),)

    out = io.BytesIO()
    np.savez(out, about=np.array([Runs()], dtype=object))
    return out.getvalue()


def runs_when_loaded(folder: Path) -> bool:
    content = io.BytesIO(policy_that_runs(folder / "made"))
    np.load(content, allow_pickle=True)["about"]
    return (folder / "made").exists()


FURTHER_ATTACKS: tuple[Attack, ...] = (
    # By descriptors, on other processes
    Attack(51, "a lease: whoever opens the file waits 45 s", LOCAL + "import fcntl; fcntl.fcntl(own, 1024, 1); got('lease')", least=1),
    Attack(52, "watch what others open in a folder", "import fcntl; fcntl.fcntl(os.open(os.path.dirname(__file__), 0), 1026, 1); got('notices')", least=1),
    Attack(53, "have a pipe signal the grader", "import fcntl; ends = os.pipe(); fcntl.fcntl(ends[0], 8, GRADER); got('owner')", least=1),
    Attack(54, "have a socket signal the grader", LIBC + "import socket; end = socket.socketpair()[0]\nif libc.ioctl(end.fileno(), 0x8902, ctypes.byref(ctypes.c_int(GRADER))) == 0: got('owner')", least=1),
    Attack(55, "choose the signal of a descriptor", "import fcntl; ends = os.pipe(); fcntl.fcntl(ends[0], 10, 9); got('signal')", least=1),
    Attack(56, "live on after the kit", LIBC + "if libc.prctl(1, 0, 0, 0, 0) == 0: got('life')", least=1),
    Attack(57, "a signal with a value for the grader", LIBC + "if libc.sigqueue(GRADER, 18, None) == 0: got('signal')", least=1),
    Attack(58, "read the limits of the grader", "import resource; got(resource.prlimit(GRADER, resource.RLIMIT_NOFILE))", least=1),
    Attack(59, "set the grader's priority", "os.setpriority(os.PRIO_PROCESS, GRADER, os.getpriority(os.PRIO_PROCESS, GRADER)); got('priority')", least=1),
    Attack(60, "bind the grader to a core", "os.sched_setaffinity(GRADER, os.sched_getaffinity(GRADER)); got('cores')", least=1),
    Attack(61, "a descriptor of the grader's by number", LIBC + "handle = libc.syscall(434, GRADER, 0)\nif handle >= 0: got(libc.syscall(438, handle, 0, 0))", least=1),
    Attack(62, "read the grader's command line", "got(open(f'/proc/{GRADER}/cmdline').read())", least=1),
    Attack(63, "read the grader's state", "got(open(f'/proc/{GRADER}/status').read()[:80])", least=1),
    Attack(64, "read the environment of the process above", "got(open(f'/proc/{os.getppid()}/environ', 'rb').read())", least=1),
    # By files, on other people's work and on the next episode
    Attack(65, "list what others have handed in", "got(os.listdir(os.path.dirname(VICTIM)))", least=1),
    Attack(66, "read what another has handed in", "got(open(VICTIM).read())", least=1),
    Attack(67, "read the solutions of the kit", "import rclpy\nfor part in ('tests/solutions', 'lessons'): got(os.listdir(os.path.abspath(rclpy.__file__).partition('/kit/')[0] + '/' + part))", least=1),
    Attack(68, "bytecode for the next episode", "os.makedirs(os.path.join(os.path.dirname(__file__), '__pycache__')); got('folder')", least=1),
    Attack(69, "a note in shared memory", "name = '/dev/shm/note-%d' % os.getpid(); open(name, 'w').close(); os.unlink(name); got('note')", least=1),
    Attack(70, "an abstract socket as a mailbox", "import socket; s = socket.socket(socket.AF_UNIX); s.bind('\\0box-%d' % os.getpid()); got('box')", least=1),
    Attack(71, "memory that nobody counts", "got(os.memfd_create('x'))", least=1),
    Attack(72, "rights that outlive it", "open('tool', 'w').close(); os.chmod('tool', 0o4755); got('rights')", least=1),
    Attack(73, "times as a message", "open('note', 'w').close(); os.utime('note', (1, 1)); got('times')", least=1),
    # By what only the process of the kit can limit
    Attack(74, "messages kept for those who come later", LATCHED, LARGE, lift=without(kept=None)),
    Attack(75, "many small files", "for number in range(1500): open(str(number), 'w').close()\n" + WAIT, LARGE, end_in_own_files=RAN, lift=without(files=10**6)),
    Attack(76, "deleted files that stay open", "held = [open(str(n), 'wb') for n in range(7)]\nfor n, file in enumerate(held): file.write(bytes(7 << 20)); file.flush(); os.unlink(str(n))\n" + WAIT, LARGE, end_in_own_files=RAN, lift=without(scratch=GIB)),
    Attack(77, "a file with a hole of a terabyte", "open('hole', 'wb').truncate(1 << 40); got('hole')", control=outlasts("hole", 1 << 30)),
    Attack(78, "more messages than a moment takes", "for _ in range(2000): node.drive.publish(Twist())", LARGE, lift=without(messages=None)),
    Attack(79, "a frame larger than any answer", "from std_msgs.msg import String; big = node.create_publisher(String, 'big', 1)\nfor _ in range(40): big.publish(String(data='x' * 30000))", ODD, lift=without(frame=8 << 20)),
    Attack(80, "a signal that looks like a lack of memory", "import signal; os.kill(os.getpid(), signal.SIGKILL)", LARGE, control=ends_with(-9, "import os; os.kill(os.getpid(), 9)")),
    Attack(81, "the exit code of a process of the kit", f"os._exit({OVER_DISK_LIMIT})", LARGE, control=ends_with(OVER_DISK_LIMIT, f"import os; os._exit({OVER_DISK_LIMIT})")),
    # By what ends late
    Attack(82, "an exit handler that sleeps", "import atexit, select; atexit.register(select.select, [], [], [], 1000); rclpy.shutdown()", SLOW, control=keeps_python_from_ending("import atexit, select; atexit.register(select.select, [], [], [], 1000)")),
    Attack(83, "a thread that never ends", "import select, threading; threading.Thread(target=select.select, args=([], [], [], 1000)).start()", control=keeps_python_from_ending("import select, threading; threading.Thread(target=select.select, args=([], [], [], 1000)).start()")),
    Attack(84, "a destructor that sleeps", LATE.replace("late =", "sys.modules['__main__'].late ="), control=keeps_python_from_ending(LATE)),
    # By frames in the wrong state
    Attack(85, "says that it cannot be confined", whole=WRITE_FRAME.replace("FRAME", "['refused', 'no Landlock here']"), end=ODD, sheet=HASTY, control=believes_every_frame("says that it cannot be confined")),
    # By archives and folders
    Attack(86, "a file and a folder of one name", pack=BOTH, end=REFUSED, control=fails_to_extract(BOTH)),
    Attack(87, "two programs of one name", pack=TWICE, end=REFUSED, control=extracts_to(TWICE, "controller.py", lambda file: file.read_text() == HARMLESS)),
    Attack(88, "an absolute name", pack=zip_of(("/tmp/evil.py", b"x"), ("controller.py", b"x")), end=REFUSED, control=leaves_by_its_name("/tmp/evil.py")),
    Attack(89, "backslashes that lead out", pack=zip_of(("..\\..\\evil.py", b"x"), ("controller.py", b"x")), end=REFUSED, control=lambda folder: ".." in PureWindowsPath("..\\..\\evil.py").parts),
    Attack(90, "another drive", pack=zip_of(("C:evil.py", b"x"), ("controller.py", b"x")), end=REFUSED, control=lambda folder: PureWindowsPath("D:/in", "C:evil.py").drive == "C:"),
    Attack(91, "an archive with a password", pack=locked_zip, end=REFUSED, control=fails_to_extract(locked_zip)),
    Attack(92, "entries that overlap", pack=overlapping_zip, end=REFUSED, control=promises_far_more),
    Attack(93, "links in a zip archive", pack=linking_zip, end=REFUSED, control=lambda folder: linking_zip(folder / "handed") is None and all(each.external_attr >> 16 == 0o120777 for each in zipfile.ZipFile(folder / "handed.zip").infolist())),
    Attack(94, "a hard link in a tar archive", pack=tar_of("controller.py", tarfile.LNKTYPE, "/etc/passwd"), end=REFUSED, control=hard_links),
    Attack(95, "a pipe in a tar archive", pack=tar_of("controller.py", tarfile.FIFOTYPE), end=REFUSED, control=extracts_to(tar_of("controller.py", tarfile.FIFOTYPE), "controller.py", Path.is_fifo)),
    Attack(96, "a second header with another name", pack=tar_that_renames, end=REFUSED, control=renames),
    Attack(97, "a folder that is a link", pack=linked_folder, end=REFUSED, control=linked_passwords),
    Attack(98, "a pipe as the program", pack=waiting_pipe, end=REFUSED, control=is_pipe),
    Attack(99, "names that one file system takes for one", pack=zip_of(("controller.py", HARMLESS.encode()), ("caf\u00e9.txt", b"1"), ("cafe\u0301.txt", b"2")), control=lambda folder: unicodedata.normalize("NFC", "cafe\u0301.txt") == "caf\u00e9.txt"),
    Attack(100, "a thousand folders in each other", pack=zip_of(("controller.py", HARMLESS.encode()), ("a/" * 1200 + "b.py", b"1")), control=too_deep),
    # By worlds
    Attack(101, "a world that reads the secrets", whole=WORLD, files=world_files(room=ROOM.replace(b"room.dat", b"../../assignment/secret.yaml")), sheet=WORLD_SHEET, end=UNREAD, assignment_files={"hidden.dat": SQUARE}, control=leaves_by_its_name("../../assignment/secret.yaml")),
    Attack(102, "a world by an absolute path", whole=WORLD.replace("room.yaml", "/etc/passwd"), files=world_files(), sheet=WORLD_SHEET, end=UNREAD, control=leaves_by_its_name("/etc/passwd")),
    Attack(103, "seven lines of ten million words", whole=ALIASES, sheet=WORLD_SHEET, end=UNREAD, control=loads_for_ever_more),
    Attack(104, "a list within itself", whole="properties: &a [*a]\n", sheet=WORLD_SHEET, end=UNREAD, control=lambda folder: (content := yaml.unsafe_load("&a [*a]"))[0] is content),
    Attack(105, "an object of Python's in YAML", whole="properties: !!python/object/apply:os.getpid []\n", sheet=WORLD_SHEET, end=UNREAD, control=lambda folder: yaml.unsafe_load("!!python/object/apply:os.getpid []") == os.getpid()),
    Attack(106, "a picture of 36 million points", whole=WORLD, files=world_files(room=PICTURE_ROOM, picture=picture_bomb()), sheet=WORLD_SHEET, end=UNREAD, control=lambda folder: len(picture_bomb()) < MAX_SMALL),
    Attack(107, "a robot larger than the picture", whole=WORLD, files=world_files(robot=ROBOT.replace("RADIUS", "1e12").encode()), sheet=WORLD_SHEET, end=End(10.0, "pass"), control=cannot_be_drawn),
    Attack(108, "numbers that are none in a map", whole=WORLD, files=world_files(dat=b"nan nan inf 1e999\n"), sheet=WORLD_SHEET, end=UNREAD, control=lambda folder: not np.isfinite([float(each) for each in ["nan", "nan", "inf", "1e999"]]).any()),
    Attack(109, "a world that is a pipe's worth of walls", whole=WORLD, files=world_files(dat=SQUARE * 30_000), sheet=WORLD_SHEET, end=UNREAD, control=lambda folder: len(SQUARE * 30_000) < 8 * MAX_SMALL),
    # By answers
    Attack(110, "all answers at once", whole="turn: [left, right]\nspeed: [0.5, 0.6]\n", sheet=ANSWERS_SHEET, end=UNREAD, control=lambda folder: marked_carelessly("turn: [left, right]", "left")),
    Attack(111, "a number that equals every other", whole="turn: right\nspeed: .nan\n", sheet=ANSWERS_SHEET, end=UNREAD, control=lambda folder: marked_carelessly("speed: .nan", 0.5)),
    # By functions
    Attack(112, "the reference by its path", whole="import os\nexec(open(os.path.dirname('SECRET_FILE') + '/reference.py').read())\nhalf = type(half)(half.__code__, globals())\nhalf.__module__ = 'student'\n", sheet=FUNCTION_SHEET, end=STOPPED, least=1, assignment_files=REFERENCE),
    Attack(113, "a value that equals every other", whole="class All:\n    def __eq__(self, other): return True\n    def __sub__(self, other): return 0.0\n    __hash__ = None\ndef half(x): return All()\n", sheet=FUNCTION_SHEET, end=STOPPED, assignment_files=REFERENCE, control=equals_everything),
    Attack(114, "a number of a class of its own", whole="class Number(float):\n    def __eq__(self, other): return True\n    __hash__ = None\ndef half(x): return Number(x)\n", sheet=FUNCTION_SHEET, end=UNREAD, assignment_files=REFERENCE, control=number_equals_everything),
    Attack(115, "a number that has no end", whole="def half(x): return float('inf')\n", sheet=FUNCTION_SHEET, end=STOPPED, assignment_files=REFERENCE, control=lambda folder: json.loads("1e999") == float("inf")),
    Attack(116, "more numbers than a frame takes", whole="def half(x): return [[1e-300] * 100000] * 10\n", sheet=FUNCTION_SHEET + PATIENT, end=ODD, assignment_files=REFERENCE, control=lambda folder: len(json.dumps([[1e-300] * 100000] * 10)) > (GRADER_LIMITS.frame or 0)),
    # By words that others read
    Attack(117, "a log that writes to the teacher's terminal", "node.get_logger().info('\\x1b]0;x\\x07\\x1b[2J\\u202e\\u2066')", control=lambda folder: not "\x1b]0;x\x07\u202e".isprintable()),
    Attack(118, "an error that reads backwards", "raise ValueError('\\u202e\\u2066stniop 01 fo 01')", STOPPED, caught="ZeroDivisionError", control=lambda folder: unicodedata.bidirectional("\u202e") == "RLO"),
    Attack(119, "an error whose class is a command", "raise type('E\\n::set-output name=x::', (Exception,), {})('x')", STOPPED, caught="ZeroDivisionError", control=lambda folder: type("E\n::set-output::", (Exception,), {}).__name__.splitlines()[1].startswith("::")),
    Attack(120, "an error without words", "class Mute(Exception):\n    def __str__(self): raise SystemExit\n    __repr__ = __str__\nraise Mute", STOPPED, caught="ZeroDivisionError", control=has_no_words),
    Attack(121, "a stack dump at line 10 to the 5000", DUMP, STOPPED, control=no_number),

    Attack(122, "a letter to a service of the machine, without connecting", DATAGRAM, least=1),
    # By tasks
    Attack(123, "a task in a world of 25 square kilometres", whole=TASK, files=task_files(dat=BIG_SQUARE), sheet=TASK_SHEET, end=LARGE, control=lambda folder: 8 * (5_000 / FLOOR_CELL) ** 2 > MEMORY_LIMIT),
    Attack(124, "a task whose episodes do not end", whole=ENDLESS, files=task_files(), sheet=TASK_SHEET.replace("total: 120", "total: 10, submission: 10").replace("start: 60, reply: 60", "start: 5, reply: 5"), end=End(1.0, "timeout"), control=never_ends),
    Attack(125, "a task whose world reads the secrets", whole=TASK, files=task_files(room=ROOM.replace(b"room.dat", b"../../assignment/secret.yaml")), sheet=TASK_SHEET, end=UNREAD, assignment_files={"hidden.dat": SQUARE}, control=leaves_by_its_name("../../assignment/secret.yaml")),
    Attack(126, "a policy that is a program", whole=TASK, files=task_files() | {"best.npz": policy_that_runs(Path("made-by-a-policy"))}, sheet=TASK_SHEET[: TASK_SHEET.index("  - {check: sound")] + "  - {check: arrives, points: 10}\n", end=UNREAD, control=runs_when_loaded),
    # By being stopped
    Attack(127, "stop all its threads, and never be over", "import signal; os.kill(os.getpid(), signal.SIGSTOP)", SLOW, sheet=HASTY, control=never_ends_when_stopped),
)  # fmt: skip
