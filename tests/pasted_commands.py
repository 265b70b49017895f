"""A student's home, its shell, and the commands of a lesson as they stand on a screen of 80 columns."""

from __future__ import annotations

import os
import re
import shlex
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import pytest

from kit.document.blocks import Marked
from kit.document.code_lines import is_command
from kit.document.layout import Page, rows_of
from kit.document.rows import MARGIN, Row, text_width
from kit.school.lessons.aside import plain_lines
from kit.school.lessons.checking import exercise_file, install_exercise, read_solution
from kit.school.lessons.lesson_text import command_blocks
from kit.school.lessons.reading import solutions_folder
from kit.school.lessons.records import Lesson, LessonCommand, LessonStep
from kit.school.lessons.shell_lines import fill_in_paths
from kit.workspace import Workspace, open_workspace
from tests.tui.test_play_pty import User

COLUMNS = 80
REPOSITORY = Path(__file__).parents[1]
BASH = """
import os, sys
os.execvp("bash", ["bash", "--norc", "--noprofile", "-c", sys.argv[1]])
"""
ALTERNATE_SCREEN = 1049
LISTENS = ("echo", "hz", "bw")
"""Words of verbs that listen until Ctrl-C."""
LIMIT_S = 280.0
SCREEN_S = 90.0
ANSWER_S = 60.0
"""How long a question is repeated whose answer comes once a world's nodes are there [s]."""
LISTENING_S = 3.0
NOT_YET = ("Node not found", "No world is running")
"""What is said while a world opens."""
CLOCK = re.compile(r"\b\d+:\d\d\.\d\b")


@dataclass(frozen=True)
class ShownCommand:
    """A command, and the lines that a student marks with the mouse and pastes."""

    command: LessonCommand
    lines: str


def shown_commands(step: LessonStep, file: Path | None) -> list[ShownCommand]:
    """Those of a step in the order of the screen, each once: of its text, then those below it."""
    filled = [(command, fill_in_paths(command.line, file)) for command in step.commands]
    known = {tuple(shlex.split(line)): command for command, line in filled}
    page = Page(text_width(COLUMNS), MARGIN)
    text = rows_of([Marked(fill_in_paths(step.text, file))], page)
    shown: dict[tuple[str, ...], ShownCommand] = {}
    for lines in (*_code_of(text), *_code_of(rows_of(command_blocks(filled), page))):
        words = tuple(shlex.split(lines.replace("\\\n", "")))
        assert words in known, f"step {step.number} shows a command that is not among its commands:\n{lines}"
        shown.setdefault(words, ShownCommand(known[words], lines))
    assert set(shown) == set(known)
    return list(shown.values())


def _code_of(rows: Sequence[Row]) -> Iterator[str]:
    """The commands that have rows of their own, each with the rows on which it goes on."""
    open_rows: list[str] = []
    for each in rows:
        line = "".join(text for text, _ in each)
        assert len(line) <= COLUMNS
        is_code = all(style == "code" for text, style in each if text.strip())
        if open_rows or (is_code and is_command(line)):
            open_rows.append(line)
            if not line.endswith("\\"):
                yield "\n".join(open_rows)
                open_rows = []


class Home:
    """A home folder with a workspace in the usual place, and ``kit`` and ``grader`` on the path of its shell."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.folder = folder
        programs = folder / ".local" / "bin"
        programs.mkdir(parents=True)
        for name in ("kit", "grader"):
            program = programs / name
            program.write_text(f'#!/bin/sh\nexec {shlex.quote(sys.executable)} -m {name} "$@"\n')
            program.chmod(0o755)
        self._shell = programs / "shell.py"
        self._shell.write_text(BASH)
        monkeypatch.setenv("HOME", str(folder))
        monkeypatch.delenv("KIT_WORKSPACE")
        monkeypatch.setenv("PATH", f"{programs}{os.pathsep}{os.environ['PATH']}")
        monkeypatch.setenv("PYTHONPATH", str(REPOSITORY))
        monkeypatch.chdir(folder)

    @property
    def workspace(self) -> Workspace:
        return open_workspace()

    def file_of(self, lesson: Lesson, step: LessonStep) -> Path | None:
        """The student's file of the step's exercise."""
        return None if step.exercise is None else exercise_file(self.workspace, lesson, step.exercise)

    def solve(self, lesson: Lesson, step: LessonStep) -> None:
        """Lays out the files of the step's exercise, and writes the reference solution into them."""
        if step.exercise is None:
            return
        folder = install_exercise(self.workspace, lesson, step.exercise).parent
        for name, text in read_solution(lesson, step.exercise).items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(text)
        whole = solutions_folder() / lesson.name / step.exercise.name / "solution"
        for each in whole.rglob("*") if whole.is_dir() else ():
            if each.is_file() and "__pycache__" not in each.parts:
                to = folder / each.relative_to(whole)
                to.parent.mkdir(parents=True, exist_ok=True)
                to.write_bytes(each.read_bytes())

    @contextmanager
    def paste(self, lines: str) -> Iterator[PastedCommand]:
        """Runs these lines in a shell of its own, in a terminal of 80x24."""
        pasted = PastedCommand(lines, User(str(self._shell), lines))
        try:
            yield pasted
        finally:
            pasted.user.close()

    @contextmanager
    def open_world(self, lines: str) -> Iterator[PastedCommand]:
        """Keeps a world open on a screen, for questions from a second terminal, and leaves it."""
        with self.paste(lines) as world:
            world.until_screen()
            world.user.until(lambda: world.is_under_way, "the world", SCREEN_S)
            yield world
            world.leave()
            world.assert_ended_well(LIMIT_S)

    def ask(
        self, lines: str, world: PastedCommand, is_answered: Callable[[str], bool], keys: bytes = b""
    ) -> str:
        """What a command prints that asks the world of another terminal, in which ``keys`` are pressed meanwhile.

        It is repeated until what it printed is an answer, or until that has taken too long.
        """
        words = shlex.split(lines.replace("\\\n", ""))
        listens = any(word in LISTENS for word in words) and "--once" not in words
        end = time.monotonic() + ANSWER_S
        while True:
            with self.paste(lines) as pasted:
                left_at = time.monotonic() + LISTENING_S if listens else end + ANSWER_S
                while not pasted.has_ended:
                    if keys:
                        world.user.send(keys)
                    world.user.pump(0.02)
                    pasted.user.pump(0.02)
                    if time.monotonic() > left_at and is_answered(pasted.printed):
                        pasted.leave()
                        left_at = end + ANSWER_S
                    assert time.monotonic() < end + 2 * ANSWER_S, pasted.printed
                pasted.user.wait()
                # A controller's node is there a moment after its world.
                is_early = any(words in pasted.printed for words in NOT_YET)
                if (is_early or not is_answered(pasted.printed)) and time.monotonic() < end:
                    continue
                pasted.assert_ended_well(LIMIT_S, (0, 130) if listens else (0,))
                return pasted.printed


class PastedCommand:
    """A command that runs in a shell of its own, in a terminal."""

    def __init__(self, lines: str, user: User) -> None:
        self.lines, self.user = lines, user

    @property
    def has_screen(self) -> bool:
        return ALTERNATE_SCREEN in self.user.modes.on

    @property
    def printed(self) -> str:
        """Everything that it printed, without colours."""
        return "\n".join(plain_lines(self.user.output.decode(errors="replace")))

    @property
    def has_ended(self) -> bool:
        return self.user.process.poll() is not None

    @property
    def is_under_way(self) -> bool:
        """Whether the screen shows more than that it opens, and a world on it has begun to move."""
        text = self.user.text
        clock = CLOCK.search(text.splitlines()[0])
        return "opening" not in text and (clock is None or clock[0] != "0:00.0")

    def pump(self, seconds: float) -> None:
        end = time.monotonic() + seconds
        while time.monotonic() < end and not self.has_ended:
            self.user.pump(0.05)

    def until_screen(self) -> None:
        self.user.until(
            lambda: (self.has_screen and self.user.text.strip()) or self.has_ended, "a screen", SCREEN_S
        )
        assert self.has_screen, f"{self.lines}\n{self.printed}"

    def until_end(self, limit: float) -> None:
        """Waits until it ends by itself; where it is a training on a screen, until that is done, and leaves it."""
        self.user.until(lambda: self.has_ended or self.has_screen, "the end or a screen", limit)
        if self.has_screen:
            self.user.until(
                lambda: self.has_ended or "finished" in self.user.text, "the training's end", limit
            )
            self.user.send(b"\x03")
        self.assert_ended_well(limit)

    def leave(self) -> None:
        """Ctrl-C, as on every screen, and for what listens."""
        self.user.send(b"\x03")

    def assert_ended_well(self, limit: float, codes: Sequence[int] = (0,)) -> None:
        self.user.until(lambda: self.has_ended, "the end", limit)
        code = self.user.wait()
        assert code in codes, f"{self.lines}\nexit code {code}\n{self.printed[-3000:]}"
        assert "Traceback" not in self.printed, self.printed[-3000:]
        if code == 0:
            self.user.assert_sane()
