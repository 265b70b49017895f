"""The editor beside the robot: colours, saving, the robot that does the new thing, errors at their line, and nothing lost."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from textual import _text_area_theme
from textual.app import ComposeResult
from textual.pilot import Pilot
from textual.screen import Screen
from textual.widgets import TextArea

from kit.controllers import find_controller
from kit.host.failure import Failure, FailureKind
from kit.tui.screens.play import PlayScreen
from kit.tui.widgets.program_editor import (
    MAX_BYTES,
    ProgramEditor,
    ProgramFile,
    ProgramFileError,
    ProgramTextArea,
    editable_controller,
)
from kit.tui.widgets.text_rows import ERROR, SYNTAX_STYLES
from tests.cases import every_case
from tests.tui.lesson_stage import rows, seen, stage, text, until

PROGRAM = '''"""Drives ahead."""
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(0.05, self.go)

    def go(self):
        command = Twist()
        command.linear.x = 0.1  # "é" is two bytes
        self.drive.publish(command)


def main():
    rclpy.init()
    rclpy.spin(Driver())
'''


def test_the_private_names_of_the_text_area_are_there() -> None:
    area = ProgramTextArea()
    assert hasattr(TextArea, "_build_highlight_map")
    assert isinstance(area._highlights, dict)
    assert _text_area_theme.TextAreaTheme("x", syntax_styles={"a": SYNTAX_STYLES["keyword"]}).syntax_styles


@every_case(
    ("language", "lines", "keys", "expected"),
    [
        ("python", "    a = 1", ["enter", "b"], "    a = 1\n    b"),
        ("python", "a\nb\nc", ["ctrl+home", "x", "ctrl+end", "y"], "xa\nb\ncy"),
        ("python", "    if a:", ["enter", "b"], "    if a:\n        b"),
        ("yaml", "a:", ["enter", "b"], "a:\n  b"),
        ("python", "    if a:", ["enter", "backspace", "backspace", "b"], "    if a:\nb"),
        ("python", "  ab", ["left", "enter"], "  a\n  b"),
        ("python", "    ab", ["backspace"], "    a"),
        (None, "a:", ["enter", "b"], "a:\nb"),
    ],
)
def test_enter_begins_where_the_line_above_does(
    language: str | None, lines: str, keys: list[str], expected: str
) -> None:
    class AreaScreen(Screen[None]):
        def compose(self) -> ComposeResult:
            yield ProgramTextArea()

    async def scene(pilot: Pilot[None]) -> None:
        area = pilot.app.screen.query_one(ProgramTextArea)
        area.focus()
        area.show_text(lines, language)
        area.move_cursor(area.document.end)
        await pilot.press(*keys)
        assert area.text == expected

    stage(AreaScreen, scene)


@pytest.mark.parametrize("keys", [["enter"], ["home"], ["up"]])
def test_after_a_long_line_the_beginnings_of_lines_are_in_sight_again(keys: list[str]) -> None:
    class AreaScreen(Screen[None]):
        def compose(self) -> ComposeResult:
            yield ProgramTextArea()

    async def scene(pilot: Pilot[None]) -> None:
        area = pilot.app.screen.query_one(ProgramTextArea)
        area.focus()
        area.show_text(f"    short = 1\n    long = {'1 + ' * 40}1", "python")
        area.move_cursor(area.document.end)
        await until(pilot, lambda: area.scroll_offset.x > 0, "the end of the long line")
        await pilot.press(*keys)
        await until(pilot, lambda: area.scroll_offset.x == 0, "the lines' beginnings")

    stage(AreaScreen, scene)


def styles_in(area: ProgramTextArea) -> dict[str, set[str]]:
    """The texts that are in each style, each as long as the style goes on."""
    found: dict[str, set[str]] = {}
    for number, marks in area._highlights.items():
        line = area.document.lines[number].encode()
        for style in {style for _, _, style in marks}:
            covered = bytearray(len(line))
            for first, last, name in marks:
                if name == style:
                    covered[first:last] = b"x" * ((last or 0) - first)
            runs = re.finditer(rb"x+", bytes(covered))
            found.setdefault(style, set()).update(line[run.start() : run.end()].decode() for run in runs)
    return found


@every_case(
    ("code", "style", "expected"),
    [
        ("def go(self):\n    pass", "keyword", {"def", "pass"}),
        ("def go(self):\n    pass", "definition", {"go"}),
        ("x = \"é\" + 'b'  # ö", "string", {'"é"', "'b'"}),
        ('x = "é"  # ö', "comment", {"# ö"}),
        ('x = """one\n\ntwo"""\ny = 1', "string", {'"""one', 'two"""'}),
        ('x = """one\n\ntwo"""\ny = 1', "number", {"1"}),
        ("\tif True:", "keyword", {"if"}),
        ("x = (1,\n  'unclosed", "number", {"1"}),
        ("\n\n\nreturn", "keyword", {"return"}),
    ],
)
def test_python_is_in_colours_line_by_line(code: str, style: str, expected: set[str]) -> None:
    area = ProgramTextArea()
    area.show_text(code, "python")
    area._build_highlight_map()
    assert styles_in(area)[style] == expected


def test_the_line_of_an_error_is_marked_without_its_indent() -> None:
    area = ProgramTextArea()
    area.show_text("def go():\n    retrun\n", "python")
    area.mark_line(2)
    assert styles_in(area)[ERROR] == {"retrun"}
    area.mark_line(None)
    assert ERROR not in styles_in(area)
    area.mark_line(99)  # the file was longer when it was run
    assert ERROR not in styles_in(area)


def test_a_draft_outlives_the_editor_and_saving_ends_it(tmp_path: Path) -> None:
    file = tmp_path / "driver.py"
    file.write_text("one\n")
    ProgramFile(file).keep_draft("two\n")
    again = ProgramFile(file)
    assert (again.text, again.draft) == ("one\n", "two\n")
    again.save("two\n")
    assert file.read_text() == "two\n"
    again.reread()
    assert again.draft is None
    assert not again.draft_file.exists()
    again.keep_draft("two\n")  # the same as is saved: no draft
    assert not again.draft_file.exists()


SECOND_EDITOR = """
import sys
from pathlib import Path
from kit.tui.widgets.program_editor import ProgramFile, ProgramFileError
try:
    ProgramFile(Path(sys.argv[1]))
except ProgramFileError as error:
    sys.exit(str(error))
"""


def test_a_second_editor_of_a_program_is_refused_until_the_first_one_ends(tmp_path: Path) -> None:
    """Both would keep what is typed in the same draft."""
    file = tmp_path / "driver.py"
    file.write_text("one\n")

    def second() -> str:
        words = [sys.executable, "-c", SECOND_EDITOR, str(file)]
        return subprocess.run(words, capture_output=True, text=True, check=False).stderr

    first = ProgramFile(file)
    assert "driver.py is open in another editor" in second()
    first.save("two\n")  # another file lies there now
    assert "driver.py is open in another editor" in second()
    file.unlink()
    file.write_text("theirs\n")
    first.accept("theirs\n")
    assert "driver.py is open in another editor" in second()
    first.reread()  # its own lock does not keep it out
    first.close()
    assert second() == ""


def test_a_file_that_was_saved_after_a_draft_is_overwritten_only_when_asked_twice(tmp_path: Path) -> None:
    file = tmp_path / "driver.py"
    file.write_text("one\n")
    ProgramFile(file).keep_draft("two\n")
    os.utime(ProgramFile(file).draft_file, (1, 1))
    file.write_text("newer\n")

    class EditorScreen(Screen[None]):
        def compose(self) -> ComposeResult:
            yield ProgramEditor(ProgramFile(file))

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "the file was saved")
        editor = pilot.app.screen.query_one(ProgramEditor)
        assert editor.area.text == "two\n"
        editor.save()
        assert file.read_text() == "newer\n"
        await seen(pilot, "^S again")
        editor.save()
        assert file.read_text() == "two\n"
        editor.area.load_text("three\n")
        file.write_text("elsewhere\n")
        editor.follow_file()
        await seen(pilot, "^S twice")
        assert file.read_text() == "elsewhere\n"
        assert editor.area.text == "three\n"

    stage(lambda theme: EditorScreen(), scene)


def test_what_somebody_else_saves_is_noticed(tmp_path: Path) -> None:
    file = tmp_path / "driver.py"
    file.write_text("one\n")
    program = ProgramFile(file)
    assert program.newer_text() is None
    file.write_text("theirs\n")
    assert program.newer_text() == "theirs\n"
    program.accept("theirs\n")
    assert program.newer_text() is None


def test_a_file_is_edited_up_to_its_limit(tmp_path: Path) -> None:
    file = tmp_path / "driver.py"
    file.write_bytes(b"x" * MAX_BYTES)
    assert len(ProgramFile(file).text) == MAX_BYTES
    file.write_bytes(b"x" * (MAX_BYTES + 1))
    with pytest.raises(ProgramFileError, match="another editor"):
        ProgramFile(file)


@pytest.mark.parametrize("content", [b"\xff\xfe", None])
def test_a_file_that_is_no_text_is_refused_with_a_reason(tmp_path: Path, content: bytes | None) -> None:
    file = tmp_path / "driver.py"
    if content is not None:
        file.write_bytes(content)
    with pytest.raises(ProgramFileError, match=r"driver\.py"):
        ProgramFile(file)


def test_the_kits_own_controllers_and_agents_nodes_are_copied_once(tmp_path: Path) -> None:
    folder, runs = tmp_path / "controllers", tmp_path / "runs"
    kits = find_controller("random_walk")
    copy = editable_controller(kits, folder, runs)
    assert copy.file == folder / "my_random_walk.py"
    assert copy.file.read_bytes() == kits.file.read_bytes()
    copy.file.write_text("changed")
    assert editable_controller(kits, folder, runs).file.read_text() == "changed"
    assert editable_controller(copy, folder, runs) == copy
    (runs / "one").mkdir(parents=True)
    (runs / "one/one.py").write_text("agent")
    agents = find_controller(str(runs / "one/one.py"))
    assert editable_controller(agents, folder, runs).file.parent == folder


@pytest.mark.long
@pytest.mark.parametrize("size", [(80, 24), (160, 48)])
def test_what_is_saved_drives_at_once_and_an_error_is_shown_at_its_line(
    tmp_path: Path, size: tuple[int, int]
) -> None:
    file = tmp_path / "controllers/driver.py"
    file.parent.mkdir()
    file.write_text(PROGRAM)

    async def scene(pilot: Pilot[None]) -> None:
        screen = pilot.app.screen
        assert isinstance(screen, PlayScreen)
        await until(pilot, lambda: screen.view is not None and screen.view.speed[0] > 0.05, "it drives")
        await pilot.press("ctrl+e")
        await until(pilot, lambda: isinstance(screen.focused, ProgramTextArea), "the editor")
        await seen(pilot, "Drives ahead")
        editor = screen.query_one(ProgramEditor)
        editor.area.load_text(PROGRAM.replace("= 0.1", "= -0.2"))
        await pilot.pause()
        assert not editor.is_saved
        assert "not saved" in text(pilot)
        await pilot.press("ctrl+s")
        await until(pilot, lambda: screen.view is not None and screen.view.speed[0] < -0.1, "it goes back")
        assert file.read_text() == editor.area.text
        editor.area.load_text(PROGRAM.replace("Twist()", "Twits()"))
        await pilot.press("ctrl+s")
        await seen(pilot, "line 14: ")
        await until(pilot, lambda: styles_in(editor.area).get(ERROR) == {"command = Twits()"}, "the line")
        editor.area.load_text(PROGRAM.replace("= Twist()", "= = Twist()"))
        await pilot.press("ctrl+s")
        await until(pilot, lambda: styles_in(editor.area).get(ERROR) == {"command = = Twist()"}, "the slip")
        editor.area.load_text(PROGRAM)
        await pilot.press("ctrl+s")
        await until(pilot, lambda: ERROR not in styles_in(editor.area), "no error")
        await until(pilot, lambda: screen.view is not None and screen.view.speed[0] > 0.05, "it drives again")

    stage(
        lambda theme: PlayScreen(theme, "simple", str(file), folder=file.parent, runs=tmp_path / "runs"),
        scene,
        size=size,
    )


@pytest.mark.long
def test_letters_are_typed_in_the_editor_and_drive_beside_it(tmp_path: Path) -> None:
    folder = tmp_path / "controllers"
    folder.mkdir()

    async def scene(pilot: Pilot[None]) -> None:
        screen = pilot.app.screen
        assert isinstance(screen, PlayScreen)
        await until(pilot, lambda: screen.view is not None, "the world")
        await pilot.press("ctrl+e")
        await until(pilot, lambda: isinstance(screen.focused, ProgramTextArea), "the editor")
        editor = screen.query_one(ProgramEditor)
        assert editor.program.file == folder / "my_circle.py"  # the kit's own stays as it is
        await until(
            pilot, lambda: screen.view is not None and screen.view.controller == "my_circle", "the copy"
        )
        before = editor.area.text
        await pilot.press("w", "x", "q", "p")
        assert editor.area.text == "wxqp" + before
        assert screen.view is not None
        assert not screen.view.paused
        assert not screen.drive.state.held
        assert rows(pilot)[-1].split() == ["^S", "save", "Esc", "drive", "^E", "close", "^P", "find"]
        for _ in range(4):  # typed slowly, each letter is undone by itself
            await pilot.press(*(["ctrl+z"] if editor.area.text != before else []))
        assert editor.area.text == before
        await pilot.press("w", "escape")
        assert screen.focused is None
        await pilot.press("w")
        await until(pilot, lambda: screen.view is not None and screen.view.controller == "teleop", "by hand")
        await pilot.press("ctrl+e", "ctrl+s")  # what was saved drives, not the hand
        await until(
            pilot, lambda: screen.view is not None and screen.view.controller == "my_circle", "by program"
        )
        await pilot.press("y", "ctrl+e")
        await until(pilot, lambda: not editor.display, "closed")
        await pilot.press("ctrl+e")
        assert editor.area.text.count("y") == before.count("y") + 1

    stage(lambda theme: PlayScreen(theme, "simple", "circle", folder=folder, runs=tmp_path / "runs"), scene)
    assert (folder / ".my_circle.py.unsaved").exists()  # left without saving: kept for the next time


def test_an_error_elsewhere_is_told_without_a_mark(tmp_path: Path) -> None:
    file = tmp_path / "driver.py"
    file.write_text(PROGRAM)

    async def scene(pilot: Pilot[None]) -> None:
        editor = ProgramEditor(ProgramFile(file))
        await pilot.app.screen.mount(editor)
        editor.show_failure(Failure(FailureKind.EXCEPTION, "it broke\nand more", "other.py", 3))
        await pilot.pause()
        await seen(pilot, "it broke")
        assert ERROR not in styles_in(editor.area)
        file.write_text("theirs\n")
        editor.follow_file()
        assert editor.area.text == "theirs\n"
        editor.area.load_text("mine\n")
        file.write_text("theirs again\n")
        editor.follow_file()
        assert editor.area.text == "mine\n"
        editor.save()
        assert file.read_text() == "theirs again\n"  # asked first
        editor.save()
        assert file.read_text() == "mine\n"

    stage(lambda theme: Screen(), scene)
