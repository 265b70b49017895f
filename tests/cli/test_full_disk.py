"""Every command that writes says in one sentence that the disk is full; and what a user names is what is written."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from grader.__main__ import main as grader
from kit.cli import main as kit
from tests.endings.endings import can_mount

pytestmark = pytest.mark.long

LAUNCH_TEST = """\
import unittest

import launch
from launch_testing.actions import ReadyToTest
from launch_testing.markers import keep_alive


@keep_alive
def generate_test_description():
    return launch.LaunchDescription([ReadyToTest()])


class TestNothing(unittest.TestCase):
    def test_nothing(self):
        pass
"""
DRAWING = "########\n#      #\n#      #\n#      #\n########\n"
WRITERS = {
    "kit run --record": "kit run simple --steps 20 --record {out}",
    "kit run --bag": "kit run simple --steps 20 --bag {out}",
    "kit replay --export": "kit replay {made}/drive --export {out}.svg",
    "kit maps new": "kit maps new hall --from {made}/drawing.txt --workspace {out}",
    "kit pkg create --dest": "kit pkg create robo --dest {out}",
    "kit task pack --output": "kit task pack {made}/mine --output {out}",
    "kit task unpack --dest": "kit task unpack {made}/packed --dest {out}",
    "kit progress export": "kit progress export {out}",
    "kit study --csv": "kit study 3.4 --csv {out}",
    "kit study --svg": "kit study 3.5 --svg {out}",
    "kit study --html": "kit study 3.4 --html {out}.html",
    "kit study --json": "kit study 3.4 --json {out}",
    "kit train": "kit train turn --steps 100 --workspace {out}",
    "kit ros launch_test --junit-xml": "kit ros launch_test {made}/test_nothing.launch.py --junit-xml {out}",
    "kit quiz": "kit quiz --workspace {out}",
    "kit lesson": "kit lesson 1 --plain --workspace {out}",
    "kit help --html": "kit help --html {out}",
    "grader new": "grader new {out}",
    "grader check --output": "grader check {made}/assignment/solution.py --assignment {made}/assignment --output {out}",
    "grader report --output": "grader report {made}/result.json --output {out}",
}
"""By what names the output: a command that writes to ``{out}``. ``{made}``: a folder with what the commands read."""
ELSEWHERE = {
    "kit drive --record": "as kit run; tests.endings",
    "kit ros pkg create --dest": "kit pkg create",
    "kit ros test --junit-xml": "kit ros launch_test",
    "kit ros bag record --output": "needs a world; tests.endings",
    "kit evaluate --csv": "needs an agent; write_atomically",
    "kit evaluate --pictures": "needs an agent",
    "kit evaluate --node": "needs an agent; write_atomically",
    "kit evaluate --dest": "needs an agent; as kit pkg create",
    "kit sweep --csv": "needs trainings; write_atomically",
    "kit class report --svg": "as kit study",
    "kit class report --html": "as kit study",
    "kit class report --csv": "as kit study",
    "kit class report --json": "as kit study",
    "grader check --replay": "as kit run --record",
    "grader gradebook --feedback": "needs submissions; write_atomically",
    "grader gradebook --output": "needs submissions; write_atomically",
    "grader cohort --queue": "needs submissions; tests.endings",
}
"""Outputs that are not tried here, and why."""
REPOSITORY = str(Path(__file__).parents[2])
OUTPUT = (
    "write",
    "save",
    "record",
    "export",
    "folder to create",
    "new folder",
    "folder to unpack",
    "folder for jobs",
    "only write",
    "with --sweep: write",
    "with --package: folder",
)


def outputs(command: click.Command, name: str) -> Iterator[str]:
    """The options of all commands that name a file or folder to be written."""
    if isinstance(command, click.Group):
        context = click.Context(command)
        for each in command.list_commands(context):
            part = command.get_command(context, each)
            assert part is not None
            yield from outputs(part, f"{name} {each}")
        return
    for option in command.params:
        is_path = isinstance(option.type, click.Path) and not option.type.exists
        if is_path and isinstance(option, click.Option) and (option.help or "").lower().startswith(OUTPUT):
            yield f"{name} {max(option.opts, key=len)}"


def test_every_output_is_tried_or_told_why_not() -> None:
    found = {*outputs(kit, "kit"), *outputs(grader, "grader")}
    found = {each.replace("--destination-directory", "--dest") for each in found}
    assert sorted(found - WRITERS.keys() - ELSEWHERE.keys()) == []
    assert sorted(ELSEWHERE.keys() - found) == []


def run(words: str, made: Path, out: Path) -> subprocess.CompletedProcess[str]:
    filled = words.format(made=made, out=out)
    return subprocess.run(
        [sys.executable, "-m", *filled.split()],
        capture_output=True,
        text=True,
        stdin=subprocess.DEVNULL,
        env={
            "KIT_WORKSPACE": str(made / "ws"),
            "PATH": "/usr/bin:/bin",
            "HOME": str(made),
            "PYTHONPATH": REPOSITORY,
        },
        cwd=made,
        timeout=240,
        check=False,
    )


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What the commands read."""
    folder = tmp_path_factory.mktemp("made")
    (folder / "drawing.txt").write_text(DRAWING)
    (folder / "test_nothing.launch.py").write_text(LAUNCH_TEST)
    for words in (
        "kit run simple --steps 30 --record {made}/drive",
        "kit task new mine",
        "kit task pack {made}/mine --output {made}/packed",
        "grader new {made}/assignment",
        "grader check {made}/assignment/solution.py --assignment {made}/assignment --json --output {made}/result.json",
    ):
        done = run(words, folder, folder)
        assert done.returncode == 0, done.stderr
    return folder


@pytest.fixture(scope="module")
def full(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A full disk."""
    if not can_mount():
        pytest.skip("needs the right to mount")
    folder = tmp_path_factory.mktemp("full")
    subprocess.run(["mount", "-t", "tmpfs", "-o", "size=16k", "tmpfs", str(folder)], check=True)
    with (folder / "fill").open("wb", buffering=0) as fill:
        for size in (4096, 1):
            try:
                while True:
                    fill.write(b"x" * size)
            except OSError:
                continue
    yield folder
    subprocess.run(["umount", "-l", str(folder)], check=True)


@pytest.mark.parametrize("name", WRITERS)
def test_a_full_disk_is_one_sentence_that_names_the_place(name: str, made: Path, full: Path) -> None:
    done = run(WRITERS[name], made, full / re.sub(r"\W+", "-", name))
    said = [line for line in done.stderr.splitlines() if "space left" in line or "is full" in line]
    assert done.returncode not in (0, -11), done.stdout
    assert "Traceback" not in done.stderr
    assert len(said) == 1, done.stderr
    assert str(full) in " ".join(done.stderr.split())


ONE_FILE = [name for name, words in WRITERS.items() if words.endswith((" {out}", "{out}.svg", "{out}.html"))]


@pytest.mark.parametrize("name", ONE_FILE)
@pytest.mark.parametrize("given", ["plain", "with.a.dot", "with a space", "ünïcode"])
def test_what_is_named_is_what_is_written(name: str, given: str, made: Path, tmp_path: Path) -> None:
    """No ending is added, nothing lands elsewhere."""
    if " " in given and name != "kit run --record":
        pytest.skip("one is enough: the words of the others are split")
    folder = tmp_path / "here"
    folder.mkdir()
    out = folder / given
    if " " in given:
        words = ["run", "simple", "--steps", "5", "--record", str(out), "--workspace", str(made / "ws")]
        assert CliRunner().invoke(kit, words).exit_code == 0
    else:
        done = run(WRITERS[name], made, out)
        assert done.returncode == 0, done.stderr
    ending = WRITERS[name].rpartition("{out}")[2]
    assert [each.name for each in folder.iterdir()] == [given + ending]
