"""A command that is given a file of another kind says what the file is, and which command takes it."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Final

import click
import pytest
from click.testing import CliRunner

import grader.__main__ as grader
import kit.cli
from kit.cli.file_kinds import FILE_KINDS, kind_of, other_kinds
from kit.school.progress import ProgressJournal
from tests.cli.verbs import kit as kit_verb

ROOT: Final = Path(__file__).parents[2]
COURSE: Final = ROOT / "tests" / "launch" / "course_ws" / "src" / "course_bringup"
LESSON: Final = ROOT / "lessons" / "01-drive"


def _copied(source: Path) -> Callable[[Path], Path]:
    return lambda folder: Path(shutil.copy(source, folder / source.name))


def _recording(folder: Path) -> Path:
    kit_verb("run", "maze", "--steps", 50, "--record", folder / "drive.npz")
    return folder / "drive.npz"


def _bag(folder: Path) -> Path:
    kit_verb("run", "maze", "--steps", 50, "--bag", folder / "bag")
    return folder / "bag"


def _bag_data(folder: Path) -> Path:
    return next(_bag(folder).glob("*.mcap"))


def _policy(folder: Path) -> Path:
    return _copied(sorted((ROOT / "tests" / "solutions").rglob("best.npz"))[0])(folder)


def _progress(folder: Path) -> Path:
    with ProgressJournal(folder) as journal:
        journal.export(folder / "ada.json")
    return folder / "ada.json"


def _result(folder: Path) -> Path:
    file = folder / "result.json"
    words = [
        str(LESSON / "square" / "starter.py"),
        "--assignment",
        str(LESSON / "square"),
        "--level",
        "0",
        "--json",
    ]
    file.write_text(CliRunner().invoke(grader.main, ["check", *words]).stdout)
    assert json.loads(file.read_text())
    return file


EXAMPLES: Final[Mapping[str, tuple[Callable[[Path], Path], str]]] = MappingProxyType(
    {
        "world": (_copied(ROOT / "maps" / "maze" / "world.yaml"), "kit world check"),
        "model": (_copied(next(ROOT.glob("maps/robots/*.model.yaml"))), "kit world check"),
        "map": (_copied(ROOT / "maps" / "maze" / "map.yaml"), "kit world check"),
        "about": (_copied(ROOT / "maps" / "maze" / "about.yaml"), "kit world check"),
        "task": (_copied(ROOT / "kit" / "learning" / "tasks" / "turn.yaml"), "kit train"),
        "lesson": (_copied(LESSON / "lesson.yaml"), "kit lesson"),
        "quiz": (_copied(LESSON / "quiz.yaml"), "kit lesson"),
        "sheet": (_copied(LESSON / "square" / "assignment.yaml"), "grader check"),
        "parameters": (_copied(COURSE / "config" / "params.yaml"), "kit ros param load"),
        "launch.py": (_copied(COURSE / "launch" / "course.launch.py"), "kit launch"),
        "launch.xml": (_copied(COURSE / "launch" / "course.launch.xml"), "kit launch"),
        "launch.yaml": (_copied(COURSE / "launch" / "course.launch.yaml"), "kit launch"),
        "program": (_copied(LESSON / "square" / "starter.py"), "kit run"),
        "picture": (_copied(ROOT / "maps" / "maze" / "map.png"), "kit maps from-photo"),
        "recording": (_recording, "kit replay"),
        "policy": (_policy, "kit evaluate"),
        "bag": (_bag, "kit ros bag info"),
        "bag's data": (_bag_data, "kit ros bag info"),
        "package": (lambda folder: COURSE, "kit launch"),
        "progress": (_progress, "kit class report"),
        "result": (_result, "grader report"),
    }
)
"""By kind: a right example, and a command that is told to whoever gave it to another."""
READERS: Final = (
    "kit world check", "kit maps show", "kit task check", "kit layers plan", "kit run", "kit replay", "kit evaluate",
    "kit launch", "kit train", "kit ros bag info", "kit lesson --check", "kit maps from-photo", "kit class report",
    "grader report", "grader self-test",
)  # fmt: skip
"""Commands that read a file that somebody names."""


@pytest.fixture(scope="module")
def examples(tmp_path_factory: pytest.TempPathFactory) -> Mapping[str, Path]:
    made = {}
    for name, (make, _) in EXAMPLES.items():
        folder = tmp_path_factory.mktemp("kind")
        made[name] = make(folder)
    return made


def test_every_kind_has_an_example(examples: Mapping[str, Path]) -> None:
    kinds = {kind_of(path) for path in examples.values()}
    requirements = [kind for kind in FILE_KINDS if kind.name.startswith("a requirements file")]
    assert kinds == set(FILE_KINDS) - set(requirements)


def test_a_requirements_file_as_the_kit_writes_it_is_one(tmp_path: Path) -> None:
    file = tmp_path / "requirements.yaml"
    file.write_text(kit_verb("layers", "example", "slides").stdout)
    kind = kind_of(file)
    assert kind is not None
    assert kind.takes("kit layers plan")


def test_every_verb_with_an_option_for_a_program_takes_one(examples: Mapping[str, Path]) -> None:
    program = kind_of(examples["program"])
    assert program is not None
    asked = [
        line
        for line, command in verbs("kit", kit.cli.main)
        if any("--controller" in option.opts for option in command.params)
    ]
    assert "kit run" in asked
    assert [line for line in asked if not program.takes(line)] == []


def verbs(line: str, command: click.Command) -> Iterator[tuple[str, click.Command]]:
    """A command and all below it, with the line that calls each."""
    yield line, command
    if isinstance(command, click.Group):
        with click.Context(command) as context:
            for name in command.list_commands(context):
                below = command.get_command(context, name)
                assert below is not None
                yield from verbs(f"{line} {name}", below)


@pytest.mark.parametrize("reader", READERS)
def test_a_file_of_another_kind_is_named_and_one_of_its_own_is_not(
    examples: Mapping[str, Path], reader: str
) -> None:
    program, *words = reader.split()
    for name, (_, command) in EXAMPLES.items():
        told = list(other_kinds(program, [*words, str(examples[name])]))
        kind = kind_of(examples[name])
        assert kind is not None
        if kind.takes(reader):
            assert told == [], name
        else:
            assert len(told) == 1, name
            assert str(examples[name]) in told[0]
            assert command in told[0], name


def test_the_commands_that_are_told_are_there() -> None:
    for kind in FILE_KINDS:
        for command in (*kind.commands, *kind.others):
            program, *words = command.split()
            verbs = {"kit": kit.cli.VERBS, "grader": grader.VERBS}[program]
            assert not words or words[0] in verbs, command


def test_what_is_written_is_no_mistake(examples: Mapping[str, Path]) -> None:
    assert list(other_kinds("kit", ["run", "maze", "--record", str(examples["recording"])])) == []
    assert list(other_kinds("kit", ["run", "maze", f"--controller={examples['program']}"])) == []
    assert list(other_kinds("kit", ["run", "maze", f"--controller={examples['map']}"])) != []


@pytest.mark.parametrize(
    ("words", "name"),
    [(["world", "check"], "map"), (["train"], "world"), (["launch"], "quiz"), (["replay"], "policy")],
)
def test_a_command_says_it_at_its_end(examples: Mapping[str, Path], words: list[str], name: str) -> None:
    file = str(examples[name])
    command = [sys.executable, "-m", "kit", *words, file]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode in (1, 2)
    told = done.stderr.splitlines()[-1]
    assert told == next(other_kinds("kit", [*words, file]))


@pytest.mark.parametrize("damage", [b"", b"\xff\xfe\x00", b"PK\x03\x04", b"{", b"a: [" * 1000])
@pytest.mark.parametrize("suffix", [".yaml", ".npz", ".json", ".py", ".xml", ""])
def test_a_damaged_file_is_no_trouble(tmp_path: Path, suffix: str, damage: bytes) -> None:
    file = tmp_path / f"damaged{suffix}"
    file.write_bytes(damage)
    list(other_kinds("kit", ["run", str(file)]))
