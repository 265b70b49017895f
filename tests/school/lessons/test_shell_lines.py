"""What a student copies from the screen: each command of each lesson, pasted into a shell, is that command."""

from __future__ import annotations

import shlex
import subprocess
from pathlib import Path

import pytest

from kit.document.layout import Page, rows_of
from kit.document.markup import parse_markup, plain_text, wrap_blocks
from kit.document.rows import MARGIN, text_width
from kit.school.lessons.checking import exercise_file
from kit.school.lessons.lesson_text import command_blocks
from kit.school.lessons.reading import lesson_names
from kit.school.lessons.shell_lines import expand_words, fill_in_paths, second_terminal_text, shell_path
from kit.workspace import open_workspace
from tests.kit_content import kit_lesson

COLUMNS = 80
FUNCTIONS = """
kit() { for each in kit "$@"; do printf '%s\\n' "$each"; done; echo ---; }
grader() { for each in grader "$@"; do printf '%s\\n' "$each"; done; echo ---; }
"""


def pasted(lines: list[str]) -> list[list[str]]:
    """The commands that a shell makes of these lines, as words."""
    script = FUNCTIONS + "\n".join(lines)
    done = subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=True)
    return [part.splitlines() for part in done.stdout.split("---\n")[:-1]]


@pytest.mark.parametrize(
    "home", ["ada", "home of the student Ada Lovelace, who was the first to write a program"]
)
@pytest.mark.parametrize("name", lesson_names())
def test_every_command_is_pasted_as_it_stands_on_the_screen(tmp_path: Path, name: str, home: str) -> None:
    """Broken lines and all. That each does what its lesson says is tested in ``tests/test_every_lesson.py``."""
    lesson, workspace = kit_lesson(name), open_workspace(tmp_path / home)
    lines: list[str] = []
    meant: list[list[str]] = []
    for step in lesson.steps:
        file = exercise_file(workspace, lesson, step.exercise) if step.exercise is not None else None
        for command in step.commands:
            shown = rows_of(
                command_blocks([(command, fill_in_paths(command.line, file))]),
                Page(text_width(COLUMNS), MARGIN),
            )
            code = [
                "".join(text for text, _ in row) for row in shown if any(style == "code" for _, style in row)
            ]
            assert not code[-1].endswith("\\"), "else the next command would belong to this one"
            lines += code
            line = command.line.replace("{file}", shlex.quote(str(file)))
            if file is not None:
                line = line.replace("{folder}", shlex.quote(str(file.parent)))
            meant.append(shlex.split(line))
    assert max(map(len, lines), default=0) <= COLUMNS
    assert pasted(lines) == meant


def test_a_path_in_the_home_folder_is_short_and_still_the_path(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    file = tmp_path / "kit" / "my lessons" / "square.py"
    assert shell_path(file).startswith("~/kit/")
    assert pasted([f"kit run {shell_path(file)}"]) == [["kit", "run", str(file)]]
    assert expand_words(shlex.split(shell_path(file))) == [str(file)]
    assert shell_path(Path("/else where/x")) == "'/else where/x'"


SSH = "192.0.2.7 50022 198.51.100.4 22"


@pytest.mark.parametrize(
    ("environ", "commands"),
    [
        ({}, ["tmux", "kit"]),
        ({"SSH_CONNECTION": SSH}, ["ssh ada@198.51.100.4", "tmux", "kit"]),
        ({"SSH_CONNECTION": SSH, "TMUX": "/tmp/tmux-0/default,1,0"}, []),
    ],
)
def test_the_commands_fit_the_connection(environ: dict[str, str], commands: list[str]) -> None:
    text = second_terminal_text(environ, user="ada", activate=None, workspace=None)
    rows = [plain_text(row) for row in wrap_blocks(parse_markup(text), 76)]
    assert [row.strip() for row in rows if row.startswith("    ")] == commands
    assert len(rows) <= 22


def test_a_new_shell_is_told_where_the_kit_and_the_files_are() -> None:
    text = second_terminal_text(
        {}, user="ada", activate=Path("/opt/kit/bin/activate"), workspace=Path("/data/my work")
    )
    assert "    source /opt/kit/bin/activate\n    export KIT_WORKSPACE='/data/my work'" in text
