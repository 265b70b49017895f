"""Tells what a file is that a command could not use, and which command takes it.

What a file is, is told by its name, its first bytes or the keys at its margin: it need not be right to be recognized. Every
command that fails on a file of another's kind says so, since it is asked where all commands end.
"""

from __future__ import annotations

import json
import re
import zipfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from kit.plain_files import open_plain_file
from kit.plain_text import join_names

HEAD_BYTES: Final = 1 << 16
"""As much of a file is looked at."""
OUTPUT_OPTIONS: Final = frozenset({"--record", "--bag", "-o", "--output"})
"""What follows these is written, not read."""
_KEY: Final = re.compile(r"^[\"']?([A-Za-z_][\w.-]*)[\"']?\s*:", re.MULTILINE)


@dataclass(frozen=True, slots=True)
class FileLook:
    """What can be seen of a file, or of a folder, without reading it as anything."""

    path: Path
    head: bytes = b""
    keys: frozenset[str] = frozenset()
    """The words at the margin of a YAML file, or the names of a JSON file's object."""
    parts: frozenset[str] = frozenset()
    """The names in an archive, or in a folder."""

    @classmethod
    def of(cls, path: Path) -> FileLook:
        """Raises OSError."""
        if path.is_dir():
            return cls(
                path,
                parts=frozenset(inner.name for inner, _ in zip(path.iterdir(), range(1000), strict=False)),
            )
        with open_plain_file(path) as opened:
            head = opened.read(HEAD_BYTES)
            text = head.decode("utf-8", "replace")
            if path.suffix in (".yaml", ".yml"):
                return cls(path, head, frozenset(_KEY.findall(text)))
            if path.suffix == ".json":
                with suppress(ValueError, RecursionError):
                    found = json.loads(head)
                    return cls(path, head, frozenset(found) if isinstance(found, dict) else frozenset())
                return cls(path, head, frozenset(re.findall(r'"(\w+)":', text)))
            if path.suffix == ".npz":
                with suppress(zipfile.BadZipFile):
                    opened.seek(0)
                    return cls(path, head, parts=frozenset(zipfile.ZipFile(opened).namelist()))
        return cls(path, head)


@dataclass(frozen=True, slots=True)
class FileKind:
    """A kind of file or folder, and the commands that take it."""

    name: str
    """What it is, with an article."""
    is_it: Callable[[FileLook], bool]
    commands: tuple[str, ...]
    """Commands that take it, to be shown; ``{}`` stands for its name, ``{folder}`` for its folder's."""
    others: tuple[str, ...] = ()
    """How other commands begin that take it, too."""

    def takes(self, line: str) -> bool:
        """Whether a command line, without the names of files, begins with a command that takes it."""
        begins = (*(command.partition("{")[0].strip() for command in self.commands), *self.others)
        return any(f"{line} ".startswith(f"{_command_words(begin)} ") for begin in begins)

    def describe(self, path: Path) -> str:
        """What the file is, and what to do with it."""
        folder = path if path.is_dir() else path.parent
        commands = [f"`{command.format(path, folder=folder)}`" for command in self.commands]
        takes = f"{join_names(commands)} {'takes' if len(commands) == 1 else 'take'} it." if commands else ""
        return f"{path} is {self.name}. {takes}".rstrip()


def _command_words(begin: str) -> str:
    """A command without its options, and without the words in capitals that stand for others."""
    words = begin.split()
    return " ".join(
        words[
            : next(
                (i for i, word in enumerate(words) if word.startswith("-") or not word.islower()), len(words)
            )
        ]
    )


def _has_keys(*keys: str) -> Callable[[FileLook], bool]:
    return lambda look: look.keys.issuperset(keys)


def _is_map(look: FileLook) -> bool:
    return bool(look.keys & {"resolution", "scale", "type"}) and bool(look.keys & {"image", "data"})


def _is_launch_file(look: FileLook) -> bool:
    if look.path.suffix == ".py":
        return b"def generate_launch_description" in look.head
    return "launch" in look.keys or (look.path.suffix == ".xml" and b"<launch" in look.head)


def _is_bag(look: FileLook) -> bool:
    return (
        "rosbag2_bagfile_information" in look.keys
        or look.path.suffix in (".mcap", ".db3")
        or ("metadata.yaml" in look.parts and any(name.endswith((".mcap", ".db3")) for name in look.parts))
    )


FILE_KINDS: Final = (
    FileKind(
        "a world",
        lambda look: "properties" in look.keys and bool(look.keys & {"layers", "models"}),
        ("kit world check {}", "kit run {}"),
        ("kit drive", "kit fields", "kit layers", "kit launch", "kit task", "grader check"),
    ),
    FileKind(
        "a model, which a world names under `models`: `kit world check WORLD.yaml` checks it with its world",
        lambda look: "bodies" in look.keys and "properties" not in look.keys,
        (),
        ("grader check",),
    ),
    FileKind(
        "a map, the walls that a world names under `layers`: `kit world check WORLD.yaml` checks it with its world",
        _is_map,
        (),
        ("grader check",),
    ),
    FileKind(
        "what a map's folder says about it",
        lambda look: look.keys.issuperset({"title", "cases"}) and bool(look.keys & {"robot", "source"}),
        ("kit world check {folder}",),
        ("grader check",),
    ),
    FileKind(
        "a requirements file of layers",
        lambda look: bool(look.keys & {"collide", "apart", "may_see", "ghosts", "blind"}),
        ("kit layers plan {}",),
        ("kit layers", "grader check"),
    ),
    FileKind(
        "an assignment's sheet",
        _has_keys("submit", "checks"),
        ("grader check WORK --assignment {folder}", "grader self-test {folder}"),
        ("grader",),
    ),
    FileKind("a lesson", _has_keys("title", "steps"), ("kit lesson --from {folder}",), ("grader check",)),
    FileKind(
        "a lesson's questions",
        _has_keys("items"),
        ("kit lesson --from {folder}",),
        ("kit quiz", "grader check"),
    ),
    FileKind(
        "a task",
        lambda look: (
            "reward" in look.keys and bool(look.keys & {"maps", "on", "goal", "actions", "observation"})
        ),
        ("kit task check {}", "kit train {}"),
        ("kit task", "kit evaluate", "kit compare", "kit sweep", "grader check"),
    ),
    FileKind(
        "a file of parameters",
        lambda look: b"ros__parameters" in look.head and not _is_launch_file(look),
        ("kit ros param load NODE {}", "kit ros run PACKAGE PROGRAM --ros-args --params-file {}"),
        ("kit launch", "kit ros", "grader check"),
    ),
    FileKind("a launch file", _is_launch_file, ("kit launch {}",), ("kit ros launch", "grader check")),
    FileKind(
        "a program",
        lambda look: look.path.suffix == ".py",
        ("kit run MAP --controller {}", "kit drive MAP --controller {}"),
        (
            "kit drive",
            "kit launch",
            "kit ros",
            "kit train",
            "kit task",
            "kit sweep",
            "kit fields",
            "kit game",
            "kit league",
            "grader check",
        ),
    ),
    FileKind(
        "a recording",
        lambda look: "header.npy" in look.parts and "poses.npy" in look.parts,
        ("kit replay {}",),
        ("grader check",),
    ),
    FileKind(
        "a policy",
        lambda look: "about.npy" in look.parts or ("values.npy" in look.parts and "edges.npy" in look.parts),
        ("kit evaluate {}",),
        ("kit compare", "kit game", "kit league", "kit run", "kit drive", "grader check"),
    ),
    FileKind("a bag", _is_bag, ("kit ros bag info {}", "kit ros bag play {}"), ("kit ros", "grader check")),
    FileKind(
        "a picture",
        lambda look: look.head.startswith((b"\x89PNG", b"\xff\xd8\xff", b"P5", b"P2", b"GIF8", b"BM")),
        ("kit maps from-photo {} --width METRES",),
        ("grader check",),
    ),
    FileKind(
        "a package", lambda look: "package.xml" in look.parts, ("kit launch {}",), ("kit", "grader check")
    ),
    FileKind(
        "a student's exported progress",
        lambda look: look.keys.issuperset({"format", "events"}),
        ("kit class report {}", "kit progress import {}"),
        ("kit class", "grader check"),
    ),
    FileKind(
        "a result of the grader",
        _has_keys("verdict", "tests"),
        ("grader report {}",),
        ("grader gradebook", "grader check"),
    ),
)
"""Every kind, of which the first that fits is the file's."""


def kind_of(path: Path) -> FileKind | None:
    """What a file or folder is; None where that cannot be told, or it cannot be read."""
    try:
        look = FileLook.of(path)
    except (OSError, ValueError):
        return None
    return next((kind for kind in FILE_KINDS if kind.is_it(look)), None)


def other_kinds(program: str, words: Sequence[str]) -> Iterator[str]:
    """Yields a sentence for each file among the words of a command line that another command takes."""
    line = program
    for before, word in zip((program, *words), words, strict=False):
        name = word.partition("=")[2] if word.startswith("--") and "=" in word else word
        kind = kind_of(Path(name)) if name and not name.startswith("-") else None
        if kind is None:
            line += f" {word}"
        elif before not in OUTPUT_OPTIONS and not kind.takes(line):
            yield kind.describe(Path(name))
