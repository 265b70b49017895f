"""Hands every reader of other people's files inputs that are mutated from valid ones: ``python -m tests.grader.fuzzing``.

``--count 10000`` inputs for each reader, ``--seed 1``, and words that select readers by their names. An input that ends in
anything but the reader's own refusal, takes longer than ``SLOWEST_S`` of processor time, or lets the process grow by more than
``MOST_GROWTH`` bytes is printed, and kept in the folder given by ``--keep``.
"""

from __future__ import annotations

import argparse
import io
import json
import random
import re
import resource
import signal
import struct
import sys
import tarfile
import tempfile
import traceback
import zipfile
from array import array
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from PIL import Image

from grader.kinds.policy import load_submitted_policy
from grader.reading import read_assignment
from grader.submission import read_submission
from grader.submitted_files import SubmissionRefused, SubmissionUnreadable
from kit.host import protocol, wire
from kit.host.sandbox.limits import MIB
from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.tasks import TaskSpec
from kit.learning.policies.policies import Policy, PolicyError, load_policy, policy_bytes
from kit.learning.tasks.learning_task import UnknownTask
from kit.learning.tasks.task_reader import read_task
from kit.run.recording import RecordingError, load_recording
from kit.school.progress import EventKind, ProgressError, ProgressJournal, read_export
from kit.world.loading import load_world
from kit.world.problems import WorldError
from tests.grader.further_attacks import PICTURE_ROOM, ROBOT_WITH_LASER, ROOM, SQUARE, WORLD, world_files
from tests.learning.policies.test_evaluation import always

SLOWEST_S = 5.0
"""Processor time that one input may take [s]."""
MOST_GROWTH = 300 * MIB
"""Bytes by which the process may grow over all inputs of a reader."""
ODD_NUMBERS = (
    ".nan", ".inf", "-.inf", "1e999", "-1e999", "5e-324", "-0.0", "1.7976931348623157e308", "9" * 400, "-1", "0", "1e9",
    "9223372036854775808", "18446744073709551616", "0x7fffffffffffffff", "1_0", "NaN", "Infinity", "null", "true", "[]",
    "{}", '""', "[[[[[[[[1]]]]]]]]",
)  # fmt: skip
NUMBER = re.compile(rb"-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
WORD = re.compile(rb"[A-Za-z_]{2,}")


class TooSlow(BaseException):
    """An input has taken too much processor time. No ``Exception``, so that no reader takes it for one of its own."""


@dataclass(frozen=True)
class Reader:
    """One reader: valid inputs to mutate, what reads an input, and how it may refuse one."""

    valid: Callable[[], Sequence[bytes]]
    read: Callable[[bytes, Path], object]
    """(input, an empty folder)"""
    refusals: tuple[type[Exception], ...]


# Mutations


def mutated(content: bytes, rng: random.Random) -> bytes:
    """Changes an input in one to four ways."""
    for _ in range(rng.choice((1, 1, 2, 4))):
        if content.startswith(b"PK") and rng.random() < 0.7:
            content = _with_changed_member(content, rng)
        else:
            content = rng.choice(MUTATIONS)(content, rng)
    return content


def _flip(content: bytes, rng: random.Random) -> bytes:
    if not content:
        return b"\0"
    changed = bytearray(content)
    for _ in range(rng.choice((1, 1, 8))):
        changed[rng.randrange(len(changed))] ^= 1 << rng.randrange(8)
    return bytes(changed)


def _cut(content: bytes, rng: random.Random) -> bytes:
    begin, end = sorted((rng.randrange(len(content) + 1), rng.randrange(len(content) + 1)))
    return content[:begin] + content[end:] if rng.random() < 0.5 else content[:end]


def _repeat(content: bytes, rng: random.Random) -> bytes:
    begin = rng.randrange(len(content) + 1)
    part = content[begin : begin + rng.choice((1, 8, 64, 512))]
    return content[:begin] + part * rng.choice((2, 3, 50, 500)) + content[begin + len(part) :]


def _insert(content: bytes, rng: random.Random) -> bytes:
    place = rng.randrange(len(content) + 1)
    odd = rng.choice(
        (
            b"\0",
            b"\xff\xfe",
            b"\n",
            b": ",
            b"- ",
            b"[" * 300,
            b"{" * 300,
            b"&a ",
            b"*a",
            b"!!python/x ",
            b"\xed\xa0\x80",
        )
    )
    return content[:place] + odd + content[place:]


def _odd_number(content: bytes, rng: random.Random) -> bytes:
    return _replace_match(NUMBER, content, rng.choice(ODD_NUMBERS).encode(), rng)


def _other_word(content: bytes, rng: random.Random) -> bytes:
    words = WORD.findall(content[:100_000])
    return _replace_match(WORD, content, rng.choice(words), rng) if words else content


def _replace_match(pattern: re.Pattern[bytes], content: bytes, new: bytes, rng: random.Random) -> bytes:
    matches = list(pattern.finditer(content[:100_000]))
    if not matches:
        return content
    chosen = rng.choice(matches)
    return content[: chosen.start()] + new + content[chosen.end() :]


def _other_lines(content: bytes, rng: random.Random) -> bytes:
    lines = content.splitlines(keepends=True)
    if len(lines) > 1:
        one, other = rng.randrange(len(lines)), rng.randrange(len(lines))
        match rng.randrange(3):
            case 0:
                del lines[one]
            case 1:
                lines[one], lines[other] = lines[other], lines[one]
            case _:
                lines.insert(other, lines[one])
    return b"".join(lines)


def _number_of_bytes(content: bytes, rng: random.Random) -> bytes:
    """Writes a large number where a length may stand."""
    place = rng.randrange(max(1, len(content) - 8))
    size = rng.choice(("<I", ">I", "<Q", "<H"))
    number = struct.pack(
        size, rng.choice((0, 1, 0x7FFF, 0xFFFF)) if size == "<H" else rng.choice((0, 2**31 - 1, 2**32 - 1))
    )
    return content[:place] + number + content[place + len(number) :]


MUTATIONS = (_flip, _cut, _repeat, _insert, _odd_number, _other_word, _other_lines, _number_of_bytes)


def _with_changed_member(content: bytes, rng: random.Random) -> bytes:
    """Changes what is in a zip archive, so that its checksums are right."""
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            members = {each.filename: archive.read(each) for each in archive.infolist()}
    except Exception:  # noqa: BLE001  # it was changed before
        return content
    if not members:
        return content
    name = rng.choice(list(members))
    match rng.randrange(4):
        case 0:
            del members[name]
        case 1:
            members[_other_word(name.encode(), rng).decode(errors="replace") + "x"] = members[name]
        case 2 if name.endswith(".npy"):
            members[name] = _odd_array(members[name], rng)
        case _:
            members[name] = rng.choice(MUTATIONS)(members[name], rng)
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as archive:
        for each, data in members.items():
            archive.writestr(each, data)
    return made.getvalue()


def _odd_array(content: bytes, rng: random.Random) -> bytes:
    """Another array of the same name: odd numbers, another type, another shape."""
    try:
        values = np.load(io.BytesIO(content), allow_pickle=False)
    except Exception:  # noqa: BLE001  # it was changed before
        return content
    match rng.randrange(4):
        case 0 if values.dtype.kind == "f" and values.size:
            values = values.copy()
            values.flat[rng.randrange(values.size)] = rng.choice(
                (np.nan, np.inf, -np.inf, 1e308, 5e-324, -0.0)
            )
        case 1:
            values = values.astype(
                rng.choice(("f2", "f4", "f8", "i1", "i8", "u8", "?", "c16", "S3", "U2")), casting="unsafe"
            )
        case 2:
            values = rng.choice(
                (
                    values[:0],
                    values[None],
                    values.reshape(-1),
                    values[..., None],
                    np.concatenate([values, values]) if values.ndim else values,
                )
            )
        case _:
            if values.dtype.kind in "iu" and values.size:
                values = values.copy()
                values.flat[rng.randrange(values.size)] = rng.choice(
                    (0, -1 if values.dtype.kind == "i" else 1, np.iinfo(values.dtype).max)
                )
    made = io.BytesIO()
    np.save(made, values, allow_pickle=False)
    return made.getvalue()


# Readers


def _read_frame(content: bytes, folder: Path) -> object:
    return protocol.parse(wire.decode(content))


def _frames() -> Sequence[bytes]:
    values = [
        ["confined", 1],
        ["refused", "no"],
        ["failed", 3, "exception", "it failed", "a.py", 1, 1],
        ["values", 3, wire.numbers_to_text(array("d", [1.0, 2.0]))],
        ["told", 3, [1.0, "a", None, [True]]],
        ["functions", 0, ["a", "b"]],
        ["reply", 1, None, [["publish", 1, {"linear": {"x": 0.3}}]]],
        ["ended", 1, []],
    ]
    return [json.dumps(each).encode() for each in values]


def _named(name: str, read: Callable[[Path], object]) -> Callable[[bytes, Path], object]:
    def write_and_read(content: bytes, folder: Path) -> object:
        file = folder / name
        file.write_bytes(content)
        return read(file)

    return write_and_read


def _read_archive(name: str) -> Callable[[bytes, Path], object]:
    def read(file: Path) -> object:
        try:
            return read_submission(file, "controller.py")
        except SubmissionUnreadable as error:
            raise AssertionError(f"an error that no reader expects: {error.error}") from error

    return _named(name, read)


def _zips() -> Sequence[bytes]:
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("work/controller.py", "import rclpy\n" * 20)
        archive.writestr("work/notes.txt", "x")
    return [made.getvalue()]


def _tars(mode: str) -> Sequence[bytes]:
    made = io.BytesIO()
    with tarfile.open(fileobj=made, mode=mode, format=tarfile.PAX_FORMAT) as archive:  # type: ignore[call-overload]  # a mode in words
        for name in ("work/controller.py", "work/" + "long" * 40 + ".txt", "work/caf\u00e9.txt"):
            entry = tarfile.TarInfo(name)
            entry.size = 20
            archive.addfile(entry, io.BytesIO(b"import rclpy # hello"))
    return [made.getvalue()]


def _read_part(part: str) -> Callable[[bytes, Path], object]:
    """Reads a world with another file of this name beside it."""

    def read(content: bytes, folder: Path) -> object:
        for name, text in {"world.yaml": WORLD.encode(), **world_files()}.items():
            (folder / name).write_bytes(content if name == part else text)
        return load_world(folder / "world.yaml")

    return read


def _picture() -> bytes:
    made = io.BytesIO()
    Image.fromarray(np.eye(20, dtype=np.uint8) * 255).save(made, "PNG")
    return made.getvalue()


def _read_picture(content: bytes, folder: Path) -> object:
    files = world_files(room=PICTURE_ROOM, picture=content)
    for name, text in {"world.yaml": WORLD.encode(), **files}.items():
        (folder / name).write_bytes(text)
    return load_world(folder / "world.yaml")


def _tasks() -> Sequence[bytes]:
    folder = Path(__file__).parents[2] / "kit" / "learning" / "tasks"
    return [file.read_bytes() for file in sorted(folder.glob("*.yaml"))[:6]]


def _assignments() -> Sequence[bytes]:
    folder = Path(__file__).parents[2] / "lessons"
    names = ("02-nodes-and-topics/cautious", "02-nodes-and-topics/heartbeat", "12-training-strategies/stop")
    return [(folder / name / "assignment.yaml").read_bytes() for name in names]


@cache
def _policy() -> bytes:
    return policy_bytes(always(TaskSpec("turn"), 1))


def _use_policy(file: Path) -> object:
    policy: Policy = load_submitted_policy(file)
    load_policy(file)
    task = TaskSpec("turn").resolve()
    policy.check_fits(task)
    player = policy.make_player(2)
    batch = BatchEnv(task, 2, 1)
    return player.act(batch.reset(), np.ones(2, dtype=np.bool_))


def _exports() -> Sequence[bytes]:
    with tempfile.TemporaryDirectory() as folder:
        journal, file = ProgressJournal(Path(folder)), Path(folder) / "export.json"
        journal.add(EventKind.ABOUT, "name", {"value": "Ada"})
        journal.add(EventKind.STEP, "01-drive", {"step": 1})
        journal.export(file)
        return [file.read_bytes()]


def _recordings() -> Sequence[bytes]:
    header = {
        "format": 1,
        "place": "turn",
        "case": None,
        "seed": 1,
        "step_size": 0.01,
        "models": [[0, ["serp"]]],
        "inputs": [[1, "accept", ["/cmd_vel", "geometry_msgs/msg/Twist", {}]]],
        "level": None,
    }
    made = io.BytesIO()
    text = np.frombuffer(json.dumps(header).encode(), dtype=np.uint8)
    np.savez(made, header=text, poses=np.zeros((9, 3)), counts=np.ones(9, dtype=np.int64))
    return [made.getvalue()]


READERS: dict[str, Reader] = {
    "frames": Reader(_frames, _read_frame, (wire.ProtocolError,)),
    "zip": Reader(_zips, _read_archive("a.zip"), (SubmissionRefused,)),
    "tar": Reader(lambda: _tars("w"), _read_archive("a.tar"), (SubmissionRefused,)),
    "tar.gz": Reader(lambda: _tars("w:gz"), _read_archive("a.tar.gz"), (SubmissionRefused,)),
    "tar.xz": Reader(lambda: _tars("w:xz"), _read_archive("a.tar.xz"), (SubmissionRefused,)),
    "worlds": Reader(lambda: [WORLD.encode()], _read_part("world.yaml"), (WorldError,)),
    "models": Reader(lambda: [ROBOT_WITH_LASER.encode()], _read_part("robot.model.yaml"), (WorldError,)),
    "maps": Reader(lambda: [ROOM], _read_part("room.yaml"), (WorldError,)),
    "walls": Reader(lambda: [SQUARE], _read_part("room.dat"), (WorldError,)),
    "pictures": Reader(lambda: [_picture()], _read_picture, (WorldError,)),
    "tasks": Reader(_tasks, _named("task.yaml", read_task), (UnknownTask, WorldError)),
    "assignments": Reader(
        _assignments, _named("assignment.yaml", lambda file: read_assignment(file.parent)), (WorldError,)
    ),
    "policies": Reader(lambda: [_policy()], _named("best.npz", _use_policy), (PolicyError,)),
    "recordings": Reader(_recordings, _named("run.npz", load_recording), (RecordingError,)),
    "exports": Reader(_exports, _named("export.json", read_export), (ProgressError,)),
}


@contextmanager
def _limited_time() -> Iterator[None]:
    def end(*_: object) -> None:
        raise TooSlow

    before = signal.signal(signal.SIGPROF, end)
    signal.setitimer(signal.ITIMER_PROF, SLOWEST_S)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def fuzz(name: str, count: int, seed: int) -> Iterator[tuple[bytes, str]]:
    """Yields each input that a reader does not stand, and what became of it; one with empty bytes where the process grows."""
    reader, rng = READERS[name], random.Random(f"{name} {seed}")
    inputs = list(reader.valid())
    with tempfile.TemporaryDirectory() as valid_folder:
        for content in inputs:  # a mutation of what is refused anyway shows nothing
            reader.read(content, Path(valid_folder))
    before = _peak()
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(count):
            content = mutated(rng.choice(inputs), rng)
            try:
                with _limited_time():
                    reader.read(content, Path(folder))
            except reader.refusals:
                continue
            except TooSlow:
                yield content, f"more than {SLOWEST_S:g} s"
            except Exception:  # noqa: BLE001  # that is what is looked for
                yield content, traceback.format_exc(limit=-3)
    if (grown := _peak() - before) > MOST_GROWTH:
        yield b"", f"the process has grown by {grown >> 20} MiB"


def _peak() -> int:
    """The largest size that the process has had [bytes]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("readers", nargs="*", help=f"some of: {', '.join(READERS)}")
    parser.add_argument("--count", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, help="folder for inputs that a reader does not stand")
    chosen = parser.parse_args()
    failed = 0
    for name in READERS:
        if chosen.readers and not any(word in name for word in chosen.readers):
            continue
        found: dict[str, int] = {}
        for number, (content, what) in enumerate(fuzz(name, chosen.count, chosen.seed)):
            found[what] = found.get(what, 0) + 1
            if chosen.keep is not None:
                chosen.keep.mkdir(exist_ok=True)
                (chosen.keep / f"{name}-{number}").write_bytes(content)
        failed += len(found)
        print(f"{name:<12} {chosen.count:,} inputs, {sum(found.values())} not stood")
        for what, times in sorted(found.items(), key=lambda each: -each[1])[:5]:
            print(f"  {times} times: {what.strip()}")
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
