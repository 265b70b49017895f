"""The commands that the pages of ``kit help`` show, and how each is run."""

from __future__ import annotations

import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from enum import Enum
from pathlib import Path
from typing import Final

import click

from grader.__main__ import main as grader_main
from kit.cli import main as kit_main
from kit.document.blocks import Block, Code, Marked
from kit.document.code_lines import is_command
from kit.document.markup import TextStyle, parse_markup, styled_pieces
from kit.help.topic import find_topic, topic_names

ROOT: Final = Path(__file__).parents[2]
MAINS: Final = {"kit": kit_main, "grader": grader_main}


class Way(Enum):
    """How a command is run."""

    ENDS = "it ends by itself, with code 0"
    SCREEN = "it opens a full screen, which Ctrl-C leaves"
    ANSWERS = "it asks line by line; the end of its input ends it"
    SERVES = "it keeps a world open for the commands after it, until Ctrl-C"
    ASKS = "it asks the open world, and ends"
    LISTENS = "it listens to the open world until Ctrl-C"
    TRAINS = "it begins a training, which is waited for"


WAYS: Final[Mapping[str, Way]] = {
    "kit": Way.SCREEN,
    "kit lesson A1": Way.SCREEN,
    "kit lesson A2": Way.SCREEN,
    "kit drive": Way.SCREEN,
    "kit drive maze": Way.SCREEN,
    "kit drive world.yaml": Way.SCREEN,
    "kit drive ~/robot-kit/worlds/hall": Way.SCREEN,
    "kit maps new hall": Way.SCREEN,
    "kit replay run.npz": Way.SCREEN,
    "kit watch first": Way.SCREEN,
    "kit quiz": Way.SCREEN,
    "kit form": Way.SCREEN,
    "kit run maze --serve --steps 100000": Way.SERVES,
    "kit ros node list": Way.ASKS,
    "kit ros topic list -t": Way.ASKS,
    "kit ros topic echo /odom --once": Way.ASKS,
    "kit ros topic hz /static_laser": Way.LISTENS,
    "kit ros service call /pause std_srvs/srv/Empty": Way.ASKS,
    "kit ros param list": Way.ASKS,
    "kit train turn --name first --algo q-learning --steps 20000 --detach": Way.TRAINS,
    "kit train mine --name mine-1 --algo q-learning --steps 20000 --detach": Way.TRAINS,
    "kit train turn --name other-1 --algo sarsa --steps 20000 --detach": Way.TRAINS,
    "kit train turn --name robot-1 --algo q-learning --steps 20000 --detach": Way.TRAINS,
}
"""The commands that do not simply end."""

NAMES: Final = frozenset(
    (
        "grader cohort",
        "kit layers check",
        "kit drive --record",
        "kit ros bag play",
        "kit run --record",
        "kit task check",
        "kit train",
    )
)
"""Commands in a sentence that are spoken of by their name alone, without what they need."""

NOT_RUN: Final[Mapping[str, str]] = {
    "kit study 3.5 --again": "takes hours; tests/study runs a short one",
    "kit bridge zenoh": "needs a robot; tests/bridge runs it on loopback",
    "kit bridge dds": "needs a robot; tests/bridge runs it on loopback",
    "kit bridge stop": "needs a bridge; tests/bridge runs it on loopback",
    "kit train turn --reward my_reward.py": "needs torch and minutes; tests/learning trains by a student's reward",
    "kit maps new hall": "draws on the screen; tests/tui/screens/test_map_drawing.py draws one",
    "kit runs --stop first": "needs a training that still runs; tests/learning stops one",
    "kit train --resume first": "goes on with a training that was stopped; tests/learning does it",
}
"""Commands in a sentence that are not run, and why."""


def commands_in_blocks(name: str) -> list[str]:
    """The commands of a page that stand on lines of their own, in order."""
    return [line.strip() for block in _blocks(name) for line in _code_lines(block) if is_command(line)]


def commands_in_sentences(name: str) -> list[str]:
    """The commands of a page within its sentences."""
    found = (
        piece.text
        for block in _blocks(name)
        if isinstance(block, Marked)
        for part in parse_markup(block.text)
        if part.kind != "code"
        for piece in styled_pieces(part)
        if piece.style is TextStyle.CODE and is_command(piece.text)
    )
    return list(dict.fromkeys(found))


def unknown_options(text: str) -> set[str]:
    """The options of a command that it does not have; its verbs that do not exist, too."""
    program, *words = shlex.split(text)
    if "COMMAND" in words:
        return set()
    command: click.Command = MAINS[program]
    context = click.Context(command, info_name=program)
    while words and isinstance(command, click.Group):
        found = command.get_command(context, words[0])
        if found is None:
            return {words[0]} if not command.invoke_without_command and words[0].islower() else set()
        command, words = found, words[1:]
    known = {option for each in command.get_params(context) for option in each.opts} | {"--help"}
    return {word.partition("=")[0] for word in words if re.match(r"--?[a-z]", word)} - known


def has_placeholder(command: str) -> bool:
    """Whether a word stands for what a reader puts in its place: ``FILE``."""
    return any(re.fullmatch(r"[A-Z][A-Z_.-]*", word) for word in command.split())


def _blocks(name: str) -> Iterator[Block]:
    for chapter in find_topic(name).document().chapters:
        yield from chapter.blocks


def _code_lines(block: Block) -> Iterator[str]:
    if isinstance(block, Code):
        yield from block.lines
    elif isinstance(block, Marked):
        for part in parse_markup(block.text):
            if part.kind == "code":
                yield from part.lines


HALL: Final = """\
##########
#S      T#
#        #
##########
"""


def _write_drawing(folder: Path) -> None:
    (folder / "hall.txt").write_text(HALL)


def _write_class(folder: Path) -> None:
    """A folder of submissions, and one of what students exported."""
    (folder / "handed_in").mkdir()
    template = ROOT / "grader" / "templates" / "controller"
    shutil.copy(template / "solution.py", folder / "handed_in" / "ada.py")
    shutil.copy(template / "starter.py", folder / "handed_in" / "alan.py")
    (folder / "class.csv").write_text(
        "name,email,login\nAda,ada@uni.example,ada\nAlan,alan@uni.example,alan\nGrace,grace@uni.example,grace\n"
    )
    (folder / "times.csv").write_text("name,submitted\nada,2026-12-02T10:00:00\nalan,2026-11-30T10:00:00\n")
    rules, marks = (block.lines for block in _blocks("teacher") if isinstance(block, Code))
    (folder / "late.yaml").write_text("\n".join(rules) + "\n")
    (folder / "marks.yaml").write_text("\n".join(marks) + "\n")
    (folder / "answers").mkdir()
    kit = [sys.executable, "-m", "kit"]
    answers = "3\n3\n3\nq\n"
    subprocess.run(
        [*kit, "form", "--plain"], cwd=folder, input=answers, text=True, check=True, capture_output=True
    )
    exported = [*kit, "progress", "export", "answers/ada.json"]
    subprocess.run(exported, cwd=folder, check=True, capture_output=True)


def _write_world(folder: Path) -> None:
    from kit.help.topics.world_format import EXAMPLE

    for name, text in EXAMPLE.items():
        (folder / name).write_text(text)


PREPARED: Final[Mapping[str, tuple[Callable[[Path], None], ...]]] = {
    "student": (_write_drawing,),
    "ros-developer": (_write_drawing,),
    "teacher": (_write_class,),
    "world-format": (_write_world,),
}
"""What a reader of a page has already."""


def every_command() -> dict[str, list[str]]:
    """The commands of each page that a test runs: those on lines of their own, then those of its sentences."""
    return {
        name: [
            *commands_in_blocks(name),
            *(
                each
                for each in commands_in_sentences(name)
                if not has_placeholder(each)
                and each not in NOT_RUN
                and each not in NAMES
                and each not in commands_in_blocks(name)
            ),
        ]
        for name in topic_names()
    }
