"""Names that a reader takes for one another are told apart, and foreign letters in a word of Latin ones are shown."""

from __future__ import annotations

import unicodedata
from pathlib import Path

import pytest

from grader import look_alikes
from grader.look_alikes import look, mark_foreign_letters, outline
from grader.shown_names import shown_name
from grader.submission import read_submission
from tests.grader.conftest import FORWARD


@pytest.mark.parametrize(
    "other",
    [
        "\u0430da", "a\u0501a", "ad\u0251", "\u0391da", "ada ", " a\u200bda", "\uff41da", "ADA", "\u0410\u0501\u0430",
        "ada\u3164", "\uffa0ada", "a\u034fda", "ada\ufe0f", "ada\U000e0100", "\u2800ada", "ad\u180ba", "\u115f\u1160ada",
    ],
)  # fmt: skip
def test_what_looks_the_same_has_one_outline(other: str) -> None:
    assert outline(other) == outline("ada")


def test_who_is_meant_is_not_guessed_by_looks() -> None:
    assert look("\u0430da") != look("ada")
    assert look("ADA") == look("a\u200bda") == look("ada")


def test_other_names_have_other_outlines() -> None:
    names = [
        "ada",
        "adam",
        "eda",
        "s10",
        "s20",
        "s01",
        "\u0430\u043d\u043d\u0430",
        "\u0434\u0438\u043c\u0430",
    ]
    assert len(set(map(outline, names))) == len(names)


def test_every_letter_of_the_table_stands_there_once_and_is_a_letter() -> None:
    signs = [sign for _, signs in look_alikes._ALIKE for sign in signs]
    assert len(signs) == len(set(signs))
    assert [sign for sign in signs if not (sign.isalnum() or sign == "|")] == []
    assert {unicodedata.name(sign).split()[0] for sign in signs if sign.isalpha()} <= {
        "LATIN", "GREEK", "CYRILLIC", "ARMENIAN",
    }  # fmt: skip


@pytest.mark.parametrize(
    ("name", "shown"),
    [
        ("\u0441ontroller.py", "\\u0441ontroller.py"),
        ("contr\u03bfller.py", "contr\\u03bfller.py"),
        ("controller.py", "controller.py"),
        ("\u0440\u0435\u0448\u0435\u043d\u0438\u0435.py", "\u0440\u0435\u0448\u0435\u043d\u0438\u0435.py"),
        ("l\u00f6sung.py", "l\u00f6sung.py"),
    ],
)
def test_a_foreign_letter_in_a_latin_word_is_shown(name: str, shown: str) -> None:
    assert mark_foreign_letters(name) == shown
    assert shown_name(name) == f"'{shown}'"


def test_a_note_shows_which_file_was_taken(tmp_path: Path) -> None:
    (tmp_path / "\u0441ontroller.py").write_text(FORWARD)
    note = read_submission(tmp_path, "controller.py").note
    assert note.startswith("\\u0441ontroller.py was taken as controller.py")
