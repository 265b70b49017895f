"""Every text that the kit shows a person, at 80 columns: no row is wider, and no word, option, path or command is broken
inside. A word that is longer than a row may break behind a slash or a comma alone."""

from __future__ import annotations

import re
import shlex
import tokenize
from collections.abc import Iterator, Sequence
from pathlib import Path

import click
import pytest

from grader.__main__ import main as grader_main
from grader.kinds.contract import kind_names
from grader.reading import read_assignment
from kit.cli import main as kit_main
from kit.document.blocks import Block, Code, Marked, Text
from kit.document.code_lines import is_command
from kit.document.layout import Page, lines_of
from kit.learning.tasks.catalogue import TASKS
from kit.school.lessons.glossary import read_glossary
from kit.school.lessons.reading import ASSIGNMENT_FILE, lesson_names
from kit.school.lessons.records import Lesson
from kit.school.quiz.items import read_bank
from tests.cases import every_case
from tests.cli.verbs import run_main
from tests.kit_content import kit_lesson

WIDTH = 80
EDITOR_WIDTH = 74
"""Columns of a file beside its line numbers, in the kit's own editor and on the page of its exercise."""
WIDTHS = (36, 60, 76)
"""Columns of a text on a small screen, in a panel and on a screen of 80 columns."""
PARTS = re.compile(r"[^/,]*[/,]+|[^/,]+")
"""The parts of a word that may stand on rows of their own."""


def broken_words(source: str, lines: Sequence[str], width: int) -> list[str]:
    """The words of a text that its lines do not hold whole, though they would fit. Marks of code may have become a tone."""
    lines = [line.replace("`", "") for line in lines]
    shown = {word for line in lines for word in line.split()}
    words = dict.fromkeys(source.replace("`", "").split())
    lost = [word for word in words if word not in shown and len(word) <= width]
    running = "".join("".join(lines).split())
    return lost + [
        word
        for word in words
        if len(word) > width and (word not in running or not _is_broken_well(word, lines))
    ]


def _is_broken_well(word: str, lines: Sequence[str]) -> bool:
    """Whether each line that ends inside this long word ends behind a slash or a comma."""
    cuts = {
        sum(map(len, parts[:number])) for parts in [PARTS.findall(word)] for number in range(1, len(parts))
    }
    ends = [line.split()[-1] for line in lines if line.split()]
    return all(len(end) in cuts for end in ends if word.startswith(end) and end != word) or not cuts


def check(blocks: Sequence[Block], source: str, width: int) -> None:
    lines = lines_of(blocks, Page(width=width))
    assert [line for line in lines if len(line) > width] == []
    # What leads or indents a text takes columns from its words.
    assert broken_words(source, lines, width - 8) == []


def test_the_check_itself_finds_what_is_broken() -> None:
    assert broken_words("type --dry-run now", ["type --dry-", "run now"], 20) == ["--dry-run"]
    assert broken_words("a/bc", ["a/", "bc"], 3) == []
    assert broken_words("a/bc", ["a/b", "c"], 3) == ["a/bc"]
    assert broken_words("a/bc", ["a/"], 3) == ["a/bc"]


def commands(
    root: click.Command, path: tuple[str, ...] = ()
) -> Iterator[tuple[click.Command, tuple[str, ...]]]:
    yield root, path
    if isinstance(root, click.Group):
        context = click.Context(root)
        for name in root.list_commands(context):
            command = root.get_command(context, name)
            assert command is not None
            yield from commands(command, (*path, name))


HELP = [
    (main, name, path, command)
    for main, name in ((kit_main, "kit"), (grader_main, "grader"))
    for command, path in commands(main)
]


@every_case(("main", "name", "path", "command"), HELP, ids=lambda value: str(value))
def test_help(main: click.Command, name: str, path: tuple[str, ...], command: click.Command) -> None:
    lines = run_main(main, *path, "--help").output.splitlines()
    assert [line for line in lines if len(line) > WIDTH] == []
    context = click.Context(command)
    records = [
        each.get_help_record(context)
        for each in command.get_params(context)
        if isinstance(each, click.Option)
    ]
    texts = [command.help or "", command.epilog or "", *(" ".join(each) for each in records if each)]
    assert broken_words(" ".join(texts).replace("\b", ""), lines, WIDTH) == []


def shown_texts(lesson: Lesson) -> Iterator[str]:
    """Those of a lesson that are no marked text."""
    yield from (lesson.title, lesson.summary, *lesson.outcomes)
    for step in lesson.steps:
        yield from (step.title, step.goal, step.question)
        yield from (text for option in step.options for text in (option.text, option.feedback))
        yield from (claim.words for claim in step.claims)
        if step.exercise is not None and (step.exercise.folder / ASSIGNMENT_FILE).exists():
            for criterion in read_assignment(step.exercise.folder).criteria:
                yield from (criterion.title, *criterion.hints, *(each.hint for each in criterion.mistakes))


@every_case("name", lesson_names())
@every_case("width", WIDTHS)
def test_lessons(name: str, width: int) -> None:
    lesson = kit_lesson(name)
    for text in filter(None, shown_texts(lesson)):
        check([Text(text)], text, width)
    for step in lesson.steps:
        is_code = [line.startswith("    ") for line in step.text.splitlines()]
        words = "\n".join(
            line for line, code in zip(step.text.splitlines(), is_code, strict=True) if not code
        )
        check([Marked(step.text)], re.sub(r"`|\*\*|^- ", "", words, flags=re.MULTILINE), width)


@every_case("name", lesson_names())
@every_case("width", WIDTHS)
def test_commands_of_lessons(name: str, width: int) -> None:
    for step in kit_lesson(name).steps:
        for command in step.commands:
            lines = lines_of([Code((command.line,))], Page(width=width))
            assert [line for line in lines if len(line) > width] == []
            assert all(line.endswith("\\") for line in lines[:-1])
            if is_command(command.line):
                assert shlex.split("\n".join(lines).replace("\\\n", "")) == shlex.split(command.line)
            for line in lines[:-1]:
                is_in_a_word = not line.endswith(" \\")
                longest = max(map(len, command.line.split()))
                assert not is_in_a_word or longest > width - 6, lines


@every_case("width", WIDTHS)
def test_quiz_and_glossary(width: int) -> None:
    for item in read_bank().items:
        texts = [item.question, item.derivation, item.command_to_try]
        for text in filter(
            None, (*texts, *(text for option in item.options for text in (option.text, option.feedback)))
        ):
            check([Text(text)], text, width)
    for term in read_glossary():
        check([Text(term.meaning, indent=4)], term.meaning, width)


PRINTED = [
    *(("kit", "task", "show", task.name) for task in TASKS),
    ("kit", "task", "list"),
    ("kit", "task", "keys"),
    ("kit", "maps"),
    ("kit", "doctor"),
    ("kit", "layers", "example"),
    ("kit", "layers", "explain", "slides-lasers"),
    ("kit", "game", "--plain"),
    ("kit", "game", "puzzle"),
    ("kit", "game", "leaderboard"),
    ("kit", "progress"),
    ("kit", "study"),
    ("kit", "study", "3.5"),
    *(("grader", "checks", kind) for kind in kind_names()),
]


@pytest.mark.long
@every_case("words", PRINTED)
def test_what_commands_print(words: Sequence[str]) -> None:
    output = run_main(kit_main if words[0] == "kit" else grader_main, *words[1:]).output
    lines = output.splitlines()
    assert [line for line in lines if len(line) > WIDTH] == [], words
    assert [line for line in lines if re.search(r"\w-$", line)] == [], (
        "an option or a word is broken at its hyphen"
    )


def _explained_lines(file: Path) -> Iterator[tuple[int, str]]:
    """The lines of comments and of texts in a starter, counted from 1: code may be wider."""
    lines = file.read_text().splitlines()
    if file.suffix == ".yaml":
        yield from ((number, line) for number, line in enumerate(lines, 1) if "#" in line)
        return
    with file.open("rb") as source:
        for token in tokenize.tokenize(source.readline):
            is_text = token.type == tokenize.STRING and token.string.endswith('"""')
            if is_text or token.type == tokenize.COMMENT:
                yield from ((number, lines[number - 1]) for number in range(token.start[0], token.end[0] + 1))


@every_case("name", lesson_names())
def test_what_a_starter_explains_is_whole_in_the_kits_own_editor(name: str) -> None:
    files = [file for file in kit_lesson(name).folder.rglob("*") if file.suffix in (".py", ".yaml")]
    starters = [file for file in files if any(part.startswith("starter") for part in file.parts)]
    wide = [
        f"{file.relative_to(kit_lesson(name).folder)}:{number}"
        for file in starters
        for number, line in _explained_lines(file)
        if len(line) > EDITOR_WIDTH
    ]
    assert wide == []
