"""What several verbs share."""

from __future__ import annotations

import re

import pytest

from kit.cli import ELSEWHERE, messages
from kit.school.progress import FILE, EventKind, ProgressJournal
from kit.workspace import open_workspace
from tests.cli.verbs import kit


@pytest.mark.parametrize(
    "arguments",
    [("form", "before", "--show"), ("progress",), ("quiz", "--scores"), ("game", "--plain"), ("lesson",)],
    ids=" ".join,
)
def test_a_damaged_journal_is_told_by_every_verb_that_opens_it(arguments: tuple[str, ...]) -> None:
    folder = open_workspace().folder
    with ProgressJournal(folder) as journal:
        journal.add(EventKind.STEP, "lesson/1")
    (folder / FILE).write_bytes(b"no database at all" * 100)
    result = kit(*arguments)
    assert "was damaged. It was saved as" in result.stderr
    assert "was damaged" not in result.stdout


@pytest.mark.parametrize("command", ["progress", "maps", "study clip", "ros interface package std_msgs"])
def test_plain_is_taken_by_commands_that_open_no_screen(command: str) -> None:
    expected, result = kit(*command.split()), kit(*command.split(), "--plain")
    assert (result.output, result.exit_code) == (expected.output, expected.exit_code)


@pytest.mark.parametrize("word", ELSEWHERE)
def test_a_word_that_is_no_verb_leads_to_commands_that_there_are(word: str) -> None:
    said = " ".join(kit(word, code=2).stderr.split())
    named = [each.split() for each in re.findall(r"`kit ([^`]+)`", said) if each != word]
    assert named or "grader" in said
    for words in named:
        kit(*[each for each in words if each.islower() and each[0] != "-"], "--help")


def test_sentences_and_errors_are_broken_between_words(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    text = "The file runs/turn-1/config.json: damaged. " * 3 + "\n  `kit train --resume turn-1` goes on"
    messages.say(text)
    said = capsys.readouterr().out.splitlines()
    assert all(len(line) <= 78 for line in said)
    assert " ".join(said).split() == text.split()
    assert messages.on_terminal(text) == text, "a log keeps each line whole"
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    shown = messages.on_terminal(text).splitlines()
    assert all(len(line) <= 80 for line in shown)
    assert " ".join(shown).split() == text.split()
    assert shown[-1] == text.splitlines()[-1]
