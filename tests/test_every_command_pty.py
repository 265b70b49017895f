"""Every command that a lesson prints and that opens a screen, or asks a world in another terminal, does so."""

from __future__ import annotations

import os
import shlex
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import pytest

from kit.school.lessons.exercise_files import install_exercise, read_solution
from kit.school.lessons.reading import lesson_names, lessons_folder, read_lesson
from kit.school.lessons.records import CommandKind, Lesson, LessonCommand, LessonStep
from kit.workspace import open_workspace
from tests.tui.test_play_pty import KIT, User

ENDLESS = ("echo", "hz", "bw")
"""Words of verbs that listen until Ctrl-C."""


def _found(how: CommandKind) -> dict[str, tuple[str, LessonStep, LessonCommand]]:
    """Each different command once, by the lesson that prints it first."""
    return {
        f"{command.map_name} {command.line}" if how is CommandKind.BESIDE else command.line: (
            name,
            step,
            command,
        )
        for name in reversed(lesson_names())
        for step in read_lesson(lessons_folder() / name).steps
        for command in step.commands
        if command.kind is how
    }


SCREENS = _found(CommandKind.SCREEN)
BESIDE = _found(CommandKind.BESIDE)


def _lesson(name: str) -> Lesson:
    return read_lesson(lessons_folder() / name)


def _filled(name: str, step: LessonStep, line: str) -> list[str]:
    """The command's arguments, with the student's own files laid out and solved."""
    program, *arguments = shlex.split(_with_files(name, step, line))
    assert program == "kit"
    return arguments


def _with_files(name: str, step: LessonStep, line: str) -> str:
    if step.exercise is None:
        return line
    lesson, workspace = _lesson(name), open_workspace()
    file = install_exercise(workspace, lesson, step.exercise)
    for other, text in read_solution(lesson, step.exercise).items():
        (file.parent / other).write_text(text)
    return line.replace("{file}", str(file)).replace("{folder}", str(file.parent))


@contextmanager
def _screen(*arguments: str) -> Iterator[User]:
    user = User(KIT, *arguments)
    try:
        user.until(
            lambda: 1049 in user.modes.on and user.text.strip(),
            f"the screen of kit {shlex.join(arguments)}",
            90.0,
        )
        yield user
    finally:
        user.close()


@pytest.mark.long
@pytest.mark.parametrize("line", SCREENS, ids=[line.replace("{", "").replace("}", "") for line in SCREENS])
def test_a_screen_opens_and_is_left_with_ctrl_c(
    line: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    name, step, command = SCREENS[line]
    for before in step.commands[: step.commands.index(command)]:
        if before.kind is CommandKind.ALONE:
            subprocess.run(
                [sys.executable, "-m", "kit", *_filled(name, step, before.line)],
                check=True,
                capture_output=True,
            )
    with _screen(*_filled(name, step, command.line)) as user:
        for _ in range(40):
            user.pump(0.05)
        assert user.process.poll() is None, user.text
        user.send(b"\x03")
        assert user.wait() == 0, user.text
        user.assert_sane()


def _asked(user: User, arguments: Sequence[str], *, endless: bool) -> tuple[int, str, str]:
    """Asks from another terminal while the screen goes on: exit status, output and errors."""
    asking = subprocess.Popen(
        [sys.executable, "-m", "kit", *arguments],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ,
    )
    for _ in range(60 if endless else 2000):
        user.pump(0.05)
        if asking.poll() is not None:
            break
    if endless and asking.poll() is None:
        asking.send_signal(signal.SIGINT)
    out, error = asking.communicate(timeout=30)
    return asking.returncode, out, error


@pytest.mark.long
@pytest.mark.parametrize("key", BESIDE, ids=[key.replace("{", "").replace("}", "") for key in BESIDE])
def test_a_question_to_a_world_beside_is_answered(
    key: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    name, step, command = BESIDE[key]
    arguments = _filled(name, step, command.line)
    place = shlex.split(_with_files(name, step, command.map_name))
    with _screen("play", *place) as user:
        user.until(lambda: "heading" in user.text, "the world", 90.0)
        endless = any(word in ENDLESS for word in arguments) and "--once" not in arguments
        deadline = time.monotonic() + 60.0
        status, out, error = _asked(user, arguments, endless=endless)
        while (
            error == "Node not found\n" and time.monotonic() < deadline
        ):  # the world is up before its controller
            status, out, error = _asked(user, arguments, endless=endless)
        assert status in ((0, 130) if endless else (0,)), error + out
        assert "Traceback" not in error
        user.send(b"\x03")
        assert user.wait() == 0
