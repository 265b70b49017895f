"""Fuzzes what is read from files: archives, submitted YAML, recordings, worlds and saved training runs."""

from __future__ import annotations

import bz2
import gzip
import io
import json
import lzma
import random
import shutil
import struct
import tarfile
import warnings
import zipfile
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np
from PIL import Image

from grader.assignment import Assignment
from grader.evidence.contract import EvidenceOptions
from grader.kinds.contract import find_kind, read_submitted_yaml
from grader.kinds.drive import kind as drive
from grader.kinds.training import kind as training
from grader.kinds.world.world_reading import read_world_facts
from grader.reading import read_assignment
from grader.submission import read_submission
from grader.submitted_files import SubmissionRefused, SubmissionUnreadable
from kit.host.failure import Failure
from kit.host.sandbox.sandbox_config import Level
from kit.learning.policies.policy import PolicyError
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.run_config import RunConfig, RunError
from kit.learning.training.run_folders import create_run, list_runs
from kit.learning.training.runs import TrainingRun
from kit.learning.training.training import train
from kit.run.recording import RecordingError, load_recording, rerun, save_recording
from tests.fuzz.damage import (
    VALUES,
    Files,
    damage_bytes,
    damage_files,
    damage_json,
    damage_structure,
    damage_words,
    nudge_json,
)
from tests.grader.packed import array_bytes
from tests.world.test_mutations import FILES as WORLD_FILES

ROOT: Final = Path(__file__).parents[2]
SOLUTIONS: Final = ROOT / "tests" / "solutions"
PROGRAM: Final = b"import rclpy\n\ndef main():\n    pass\n"


OPTIONS: Final = EvidenceOptions(Level.LIMITED, secret=False)


def clear(folder: Path) -> Path:
    """Returns an empty folder of this path."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    return folder


class ArchiveTarget:
    """Damaged archives of every kind that the grader reads, and archives of odd entries."""

    def __init__(self, folder: Path) -> None:
        self._folder = clear(folder / "archive")
        self._packers: dict[str, Callable[[random.Random], bytes]] = {
            ".zip": _zip,
            ".tar": _tar,
            ".tar.gz": lambda rng: gzip.compress(_tar(rng), mtime=0),
            ".tar.bz2": lambda rng: bz2.compress(_tar(rng)),
            ".tar.xz": lambda rng: lzma.compress(_tar(rng)),
        }

    def attempt(self, rng: random.Random) -> str:
        """Reads one archive. SubmissionUnreadable is a finding: an error that no reader expects."""
        ending = rng.choice(sorted(self._packers))
        content = self._packers[ending](rng)
        for _ in range(rng.choice((0, 0, 0, 1, 2))):
            content = damage_bytes(rng, {"archive": content}, "archive")
        file = self._folder / f"work{rng.choice((ending, ending, ending, rng.choice(sorted(self._packers))))}"
        file.write_bytes(content)
        try:
            submission = read_submission(file, "controller.py")
        except SubmissionUnreadable:
            raise
        except SubmissionRefused:
            return "refused"
        finally:
            file.unlink()
        assert submission.main in submission.files
        return "read"


ENTRY_NAMES: Final = (
    *(
        "controller.py",
        "helpers.py",
        "work/controller.py",
        "../controller.py",
        "/controller.py",
        "CONTROLLER.PY",
    ),
    *(
        "a/" * 60 + "x.py",
        "a\\b.py",
        "C:x.py",
        "\u202econtroller.py",
        "nul\0.py",
        "x" * 300,
        "",
        ".",
        "..",
        "é.py",
    ),
    *(".git/config", "__MACOSX/._x", "controller.py/x.py", "notes.pdf", "helpers.py ", "-rf", "=1+1.py"),
)


def _entry_names(rng: random.Random) -> list[str]:
    names = rng.sample(ENTRY_NAMES, rng.choice((0, 0, 1, 1, 4)))
    return ["controller.py", *names] if rng.random() < 0.8 else names


def _content(rng: random.Random) -> bytes:
    return rng.choice(
        (PROGRAM, PROGRAM, PROGRAM, b"", b"\xff\xfe\0", rng.randbytes(60), b"PK\3\4" + PROGRAM, b"x" * 5000)
    )


def _zip(rng: random.Random) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        for name in _entry_names(rng):
            entry = zipfile.ZipInfo(name)
            entry.compress_type = rng.choice(
                (*[zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED] * 8, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA)
            )
            entry.external_attr = rng.choice((*[0o100644] * 9, 0o040755, 0o120777, 0o010644, 0)) << 16
            with warnings.catch_warnings(action="ignore"):  # a name that is there already
                archive.writestr(entry, _content(rng))
    content = bytearray(packed.getvalue())
    if rng.random() < 0.25:  # sizes, offsets and flags of a header
        places = [at for mark in (b"PK\1\2", b"PK\3\4", b"PK\5\6") for at in _positions(content, mark)]
        at = rng.choice(places) + rng.randrange(4, 46)
        number = rng.choice((0, 1, 0x7FFFFFFF, 0xFFFFFFFF, rng.getrandbits(32)))
        content[at : at + 4] = struct.pack("<I", number)
    return bytes(content)


def _positions(content: bytes | bytearray, mark: bytes) -> list[int]:
    return [at for at in range(len(content)) if content.startswith(mark, at)]


def _tar(rng: random.Random) -> bytes:
    packed = io.BytesIO()
    form = rng.choice((tarfile.USTAR_FORMAT, tarfile.GNU_FORMAT, tarfile.PAX_FORMAT))
    with tarfile.open(fileobj=packed, mode="w", format=form) as archive:
        for name in _entry_names(rng):
            if form == tarfile.USTAR_FORMAT and (len(name) > 90 or not name.isascii()):
                continue
            entry, content = tarfile.TarInfo(name), _content(rng)
            entry.type = bytes([rng.choice(b"0" * 60 + b"123456SLKxgVMN\0")])
            entry.linkname = rng.choice(("", "controller.py", "/etc/passwd"))
            entry.size = len(content) if entry.type == tarfile.REGTYPE else rng.choice((0, len(content)))
            if form == tarfile.PAX_FORMAT and rng.random() < 0.3:
                entry.pax_headers = {rng.choice(("path", "size", "comment", "GNU.sparse.map")): rng.choice(
                    ("controller.py", "-1", "1e9", "9" * 30, "0,9,0,9")
                )}  # fmt: skip
            archive.addfile(entry, io.BytesIO(content))
    content = bytearray(packed.getvalue())
    if rng.random() < 0.25:  # a field of a header, with the checksum made right again
        at = tarfile.BLOCKSIZE * rng.randrange(max(1, len(content) // tarfile.BLOCKSIZE - 1))
        field = rng.choice((slice(0, 8), slice(100, 108), slice(124, 136), slice(136, 148), slice(156, 157)))
        length = field.stop - field.start
        wrong = rng.choice((b"\xff" * 12, b"\x80" + b"\0" * 11, b"77777777777\0", rng.randbytes(12)))[:length]
        content[at + field.start : at + field.stop] = wrong
        content[at + 148 : at + 156] = b" " * 8
        total = sum(content[at : at + tarfile.BLOCKSIZE])
        content[at + 148 : at + 156] = b"%06o\0 " % total
    return bytes(content)


class SubmittedYamlTarget:
    """Damaged layer plans, answers and settings of trainings, from the works to the lessons' exercises."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder / "yaml"
        self._works = [
            (read_assignment(sheet.parent), file)
            for sheet in sorted(ROOT.glob("lessons/*/*/assignment.yaml"))
            for file in sorted(SOLUTIONS.glob(f"{sheet.parent.parent.name}/{sheet.parent.name}/**/*.yaml"))
            if read_assignment(sheet.parent).kind in ("plan", "answers", "training")
        ]
        assert {assignment.kind for assignment, _ in self._works} == {"plan", "answers", "training"}

    def attempt(self, rng: random.Random) -> str:
        """Reads one file as the kind of its exercise does."""
        assignment, file = rng.choice(self._works)
        files = damage_files(rng, {assignment.submit: file.read_bytes()})
        for name, content in files.items():
            (clear(self._folder) / name).write_bytes(content)
        failure = _submitted_failure(assignment, self._folder / assignment.submit)
        return f"{assignment.kind}: {'read' if failure is None else 'refused'}"


def _submitted_failure(assignment: Assignment, file: Path) -> Failure | None:
    """Returns why a submitted file is refused; None if it is read. Nothing is trained."""
    if assignment.kind == "training":
        read = read_submitted_yaml(file, lambda section: training._read_settings(section, assignment.task))
        return read if isinstance(read, Failure) else None
    with find_kind(assignment.kind).collect(assignment, file, OPTIONS) as collector:
        evidence = collector.evidence(assignment.criteria[0])
    return next((each.failure for each in evidence if each.failure is not None), None)


class WorldTarget:
    """Damaged worlds, and damaged files of the kit's own maps, read as the grader reads a submitted world."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder / "world"
        picture = io.BytesIO()
        Image.new("L", (6, 5), 255).save(picture, "PNG")
        small = {name: text.encode() for name, text in WORLD_FILES.items()} | {
            "picture.png": picture.getvalue()
        }
        self._worlds: list[Files] = [small]
        for solution in sorted(SOLUTIONS.glob("0[567]-*/*/solution")):
            files = {file.name: file.read_bytes() for file in solution.iterdir() if file.is_file()}
            self._worlds.append(files)
        self._worlds = [files for files in self._worlds if "world.yaml" in files and self._read(files)]
        assert len(self._worlds) > 3

    def attempt(self, rng: random.Random) -> str:
        """Reads one world. AssertionError if it is refused without a reason."""
        return "read" if self._read(damage_files(rng, rng.choice(self._worlds))) else "refused"

    def _read(self, files: Files) -> bool:
        folder = clear(self._folder)
        for name, content in files.items():
            (folder / name).write_bytes(content)
        facts, world = read_world_facts(folder / "world.yaml")
        assert (world is None) == bool(facts.problems)
        return world is not None


class RecordingTarget:
    """Damaged recordings: read as a replay reads them and run again, or judged as a drive that was handed in."""

    def __init__(self, folder: Path) -> None:
        self._file = folder / "drive.npz"
        self._assignment = read_assignment(ROOT / "lessons" / "01-drive" / "flag")
        scenario = self._assignment.task.scenario
        assert scenario is not None
        self._world = scenario.world
        whole = load_recording(SOLUTIONS / "01-drive" / "flag" / "solution.npz")
        short = replace(
            whole,
            inputs=tuple(each for each in whole.inputs if each.tick < SHORT_TICKS),
            poses=whole.poses[: int(whole.counts[:SHORT_TICKS].sum())],
            counts=whole.counts[:SHORT_TICKS],
        )
        save_recording(short, self._file)
        self._members = members_of(self._file.read_bytes())

    def attempt(self, rng: random.Random) -> str:
        """Reads one recording."""
        self._file.write_bytes(damaged_archive(rng, self._members))
        if rng.random() < 0.5:
            with drive.collect(self._assignment, self._file, OPTIONS) as collector:
                (evidence,) = collector.evidence(self._assignment.criteria[0])
            return f"judged: {'read' if evidence.failure is None else 'refused'}"
        try:
            recording = load_recording(self._file)
            if recording.ticks <= 2 * SHORT_TICKS:
                rerun(recording, self._world)
        except RecordingError:
            return "replayed: refused"
        return "replayed: read"


SHORT_TICKS: Final = 20


class RunTarget:
    """Damaged folders of training runs: listed, summarised, played, and sometimes trained on."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder / "runs"
        config = RunConfig(TaskSpec("turn"), "q-learning", steps=TRAINED_STEPS, keep_training=True)
        run = create_run(clear(folder / "sound"), config, "sound")
        train(run)
        self._files = {file.name: file.read_bytes() for file in run.folder.iterdir() if file.is_file()}
        assert {"config.json", "events.jsonl", "checkpoint.zip", "newest.npz"} <= set(self._files)
        self._task = config.choice.resolve()

    def attempt(self, rng: random.Random) -> str:
        """Reads one run, in every way in which one is read."""
        folder = clear(self._folder) / "damaged"
        folder.mkdir()
        for name, content in self._damaged_files(rng).items():
            (folder / name).write_bytes(content)
        assert len(list_runs(self._folder)) <= 1
        run = TrainingRun(folder)
        run.summary()
        outcomes = [_outcome("config", run.config), _outcome("policy", lambda: self._play(run))]
        if rng.random() < 0.1:
            outcomes.append(_outcome("trained on", lambda: self._train(run)))
        return ", ".join(outcomes)

    def _damaged_files(self, rng: random.Random) -> Files:
        files = dict(self._files)
        for name in rng.sample(sorted(files), rng.randint(1, 2)):
            if rng.random() < 0.05:
                del files[name]
            elif name.endswith((".zip", ".npz")):
                files[name] = damaged_archive(rng, members_of(files[name]))
            elif name.endswith(".jsonl"):
                files[name] = _damaged_lines(rng, files[name])
            elif files[name]:
                way = rng.choice((damage_bytes, damage_words, damage_structure))
                files[name] = (
                    way(rng, files, name) if name.endswith(".json") else damage_bytes(rng, files, name)
                )
        return files

    def _play(self, run: TrainingRun) -> None:
        policy = run.policy()
        policy.check_fits(self._task)
        seen = np.zeros((2, self._task.observation.size * self._task.robots), dtype=np.float32)
        for chance in (None, np.random.default_rng(1)):
            actions = policy.make_player(2, chance).act(seen)
            assert (actions >= 0).all()
            assert (actions < policy.choices[0]).all()

    def _train(self, run: TrainingRun) -> None:
        config = run.config()
        if (config.choice.task, config.algorithm) == ("turn", "q-learning"):
            with suppress(KeyboardInterrupt):
                train(run, interrupted=lambda: True)


TRAINED_STEPS: Final = 2000


def _outcome(name: str, read: Callable[[], object]) -> str:
    try:
        read()
    except (RunError, PolicyError):
        return f"{name} refused"
    return f"{name} read"


def _damaged_lines(rng: random.Random, content: bytes) -> bytes:
    """Damages one line of JSON, or the whole file."""
    lines = content.splitlines()
    at = rng.randrange(len(lines))
    if rng.random() < 0.3:
        return damage_bytes(rng, {"lines": content}, "lines")
    change = rng.choice((damage_json, nudge_json))
    lines[at] = json.dumps(change(rng, json.loads(lines[at]))).encode()
    return b"\n".join(lines) + b"\n"


def members_of(archive: bytes) -> Files:
    """Returns the files of a zip archive: of a checkpoint, a policy, a recording."""
    with zipfile.ZipFile(io.BytesIO(archive)) as opened:
        return {name: opened.read(name) for name in opened.namelist()}


def damaged_archive(rng: random.Random, members: Mapping[str, bytes]) -> bytes:
    """Returns an archive with one member damaged and its checksum right, or one that is damaged itself."""
    members = dict(members)
    name = rng.choice(sorted(members))
    way = rng.randrange(6)
    if way == 0:
        members.pop(name)
    elif way == 1:
        members[rng.choice(sorted(members))] = members[name]
    elif way == 2:
        members[name] = damage_bytes(rng, members, name)
    elif way < 5:
        members[name] = _damaged_member(rng, members[name])
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", rng.choice((zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED))) as archive:
        for each, content in members.items():
            archive.writestr(each, content)
    content = packed.getvalue()
    return damage_bytes(rng, {"archive": content}, "archive") if way == 5 else content


def _damaged_member(rng: random.Random, content: bytes) -> bytes:
    """Damages what a member means: the JSON in it, or the shape, the type or the numbers of its array."""
    if not content.startswith(b"\x93NUMPY"):
        return json.dumps(rng.choice((damage_json, nudge_json))(rng, json.loads(content))).encode()
    array = np.load(io.BytesIO(content))
    if array.dtype == np.uint8:
        document = rng.choice((damage_json, nudge_json))(rng, json.loads(array.tobytes()))
        return array_bytes(np.frombuffer(json.dumps(document).encode(), dtype=np.uint8))
    way = rng.randrange(6)
    if way == 0:
        return array_bytes(array.astype(rng.choice(("f4", "i1", "c8", "U3", "M8[s]", "?", "i8", "f2"))))
    if way == 1:
        return array_bytes(
            rng.choice((array[:0], array[:1], array.T, array.ravel(), array[None], array[0, ...]))
        )
    if way == 2 and array.size:
        values = [float(value) for value in VALUES if type(value) in (int, float) and abs(value) < 1e30]
        array = array.astype("f8").copy()
        array.flat[rng.randrange(array.size)] = rng.choice((*values, np.nan, np.inf, -1.0))
        return array_bytes(array)
    start = content.index(b"\n") + 1
    if way == 3:
        return damage_bytes(rng, {"header": content[:start]}, "header") + content[start:]
    if way == 4:
        return content[:start] + content[start : start + rng.randrange(max(1, len(content) - start))]
    word = rng.choice((b"(9**9,", b"(10**12,)", b"(-1,)", b"(" * 300, b"'O'", b"[]", b"None"))
    return content[:start].replace(b"(", word, 1) + content[start:]
