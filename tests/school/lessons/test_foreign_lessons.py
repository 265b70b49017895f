"""Lessons of other authors: Markdown, the kit's commands alone, confined programs, and a contract to check."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner
from textual.pilot import Pilot

from kit.cli import main
from kit.document.markup import parse_markup
from kit.host.sandbox.probe import is_level_available
from kit.host.sandbox.sandbox_config import INTERACTIVE_LEVEL
from kit.school.lessons.lesson_session import LessonSession
from kit.school.lessons.markdown import markdown_to_markup
from kit.school.lessons.reading import read_lesson
from kit.school.lessons.records import scene_confinement_level
from kit.school.progress import ProgressJournal
from kit.tui.screens.lesson import LessonScreen
from kit.workspace import open_workspace
from kit.world.problems import WorldError
from tests.tui.lesson_folder import write_lessons
from tests.tui.lesson_stage import seen, stage, text

MARKDOWN = """\
## Why

It goes *round* and [on](https://example.org),
twice: `kit maps`.

1. red
2. **green**

```python
go = 1
```
"""


@pytest.fixture
def lesson(tmp_path: Path) -> Path:
    """A lesson of somebody else's, with a solution and a wrong work for the quicker of its exercises."""
    folder = write_lessons(tmp_path / "theirs") / "01-colours"
    for name, files in {
        "colour": {"solution.yaml": "colour: green\n", "wrong/colour__red.yaml": "colour: red\n"},
    }.items():
        for file, content in files.items():
            (folder / "solutions" / name / file).parent.mkdir(parents=True, exist_ok=True)
            (folder / "solutions" / name / file).write_text(content)
    sheet = folder / "lesson.yaml"
    whole = sheet.read_text()
    sheet.write_text(whole[: whole.index("  - kind: make")].replace("It goes round.", "It goes *round*."))
    return folder


def test_markdown_becomes_the_markup_of_lessons() -> None:
    blocks = parse_markup(markdown_to_markup(MARKDOWN))
    assert [each.kind for each in blocks] == ["paragraph", "paragraph", "bullet", "bullet", "code"]
    assert blocks[0].lines == ("**Why**",)
    assert blocks[1].lines == ("It goes round and on (https://example.org), twice: `kit maps`.",)
    assert blocks[3].lines == ("**green**",)
    assert blocks[4].lines == ("go = 1",)


def test_it_is_kept_apart_from_the_kits_lesson_of_that_name(lesson: Path) -> None:
    theirs = read_lesson(lesson, is_foreign=True)
    assert theirs.name.startswith("01-colours-")
    assert "It goes round." in theirs.steps[2].text
    scene = theirs.steps[0].scene
    assert scene is not None
    level = scene_confinement_level(scene)
    assert level > INTERACTIVE_LEVEL or not any(is_level_available(each) for each in type(level) if each)


@pytest.mark.parametrize("line", ["curl example.org", "kitchen maps", '" "'])
def test_only_commands_of_the_kit(line: str, lesson: Path) -> None:
    sheet = lesson / "lesson.yaml"
    sheet.write_text(sheet.read_text().replace("line: kit maps", f"line: {line}"))
    with pytest.raises(WorldError, match="is not a command of the kit"):
        read_lesson(lesson, is_foreign=True)
    done = CliRunner().invoke(main, ["lesson", "--check", str(lesson)])
    assert done.exit_code == 1
    assert "is not a command of the kit" in done.output


@pytest.mark.long
def test_an_author_checks_the_contract(lesson: Path) -> None:
    done = CliRunner().invoke(main, ["lesson", "--check", str(lesson.parent)])
    assert done.exit_code == 0, done.output
    assert "[ok] 01-colours: exercise colour" in done.output
    (lesson / "solutions" / "colour" / "solution.yaml").write_text("colour: red\n")
    sheet = lesson / "lesson.yaml"
    sheet.write_text(
        sheet.read_text().replace("line: kit maps", "line: kit mops").replace("place: turn", "place: tern")
    )
    done = CliRunner().invoke(main, ["lesson", "--check", str(lesson.parent)])
    assert done.exit_code == 1
    assert [line for line in done.output.splitlines() if line.startswith("[no]")] == [
        "[no] 01-colours: step 2: kit mops",
        "[no] 01-colours: step 1: its scene has a world and a controller",
        "[no] 01-colours: exercise colour: the grader's self-test",
    ]


def test_one_lesson_opens_and_several_are_listed(lesson: Path, tmp_path: Path) -> None:
    arguments = ["lesson", "--from", str(lesson.parent), "--plain", "--workspace", str(tmp_path / "home")]
    done = CliRunner().invoke(main, arguments, input="q\n")
    assert "Colours. What a traffic light says." in done.output, done.output
    (lesson.parent / "02-more").mkdir()
    (lesson.parent / "02-more" / "lesson.yaml").write_text("title: More\n")
    done = CliRunner().invoke(main, arguments)
    assert done.output.startswith("01-colours\n02-more\n"), done.output
    assert CliRunner().invoke(main, ["lesson", "--from", str(tmp_path / "home")]).exit_code == 2


def test_its_commands_are_shown_before_they_run(lesson: Path, tmp_path: Path) -> None:
    workspace = open_workspace(tmp_path / "home")

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "step 1 of")
        screen = pilot.app.screen
        assert isinstance(screen, LessonScreen)
        screen.dialogue.enter(screen.dialogue.session.find_step(2))
        screen.show_all()
        await seen(pilot, "A list of maps")
        await pilot.press("o")
        await seen(pilot, "kit keys")
        await pilot.press("enter")
        await seen(pilot, "do not run it")
        await pilot.press("enter")
        await seen(pilot, "A list of maps")
        assert "cannot run here" not in text(pilot)

    with ProgressJournal(workspace.folder) as journal:
        session = LessonSession(read_lesson(lesson, is_foreign=True), journal, workspace)
        stage(lambda theme: LessonScreen(theme, session, workspace), scene)


def test_names_of_folders_command_no_terminal(tmp_path: Path) -> None:
    for name in ("a\x1b]0;owned\x07b", "c"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "lesson.yaml").write_text("title: x\n")
    for words in (
        ["--from", str(tmp_path)],
        ["--check", str(tmp_path)],
        ["--from", str(tmp_path / "\x1b[2J")],
    ):
        shown = CliRunner().invoke(main, ["lesson", *words]).output
        assert "owned" in shown or "[2J" in shown
        assert all(sign.isprintable() or sign == "\n" for sign in shown)


@pytest.mark.parametrize("file", ["../../../../out.yaml", "/tmp/out.yaml", "a/../../out.yaml"])
def test_an_exercise_writes_nothing_outside_its_folder(file: str, tmp_path: Path) -> None:
    """The starter would be copied there, wherever it is."""
    folder = write_lessons(tmp_path / "theirs") / "01-colours"
    whole = read_lesson(folder, is_foreign=True)
    sheet = folder / "lesson.yaml"
    sheet.write_text(sheet.read_text().replace(f"file: {whole.exercises[0].file}", f"file: {file}"))
    with pytest.raises(WorldError, match="leads out of the exercise's folder"):
        read_lesson(folder, is_foreign=True)
