"""Lessons in other languages: the same structure, the same numbers, and no gap."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from kit.school.lessons.reading import find_lesson, lessons_folder, read_lesson
from kit.school.lessons.translation import chosen_language, translation_of
from kit.school.quiz.reading import read_bank
from kit.school.survey.reading import read_form
from kit.world.problems import WorldError

TRANSLATIONS = sorted(lessons_folder().glob("*/lesson.??.yaml"))
NUMBER = re.compile(r"\d+(?:\.\d+)?")
CODE = re.compile(r"`([^`]+)`")


def test_the_first_lessons_are_there_in_portuguese() -> None:
    for number in "123":
        assert translation_of(find_lesson(number).folder / "lesson.yaml", "pt") is not None


@pytest.mark.parametrize("file", TRANSLATIONS, ids=lambda file: f"{file.parent.name}-{file.suffixes[0][1:]}")
def test_a_translation_says_the_same_of_the_same_steps(file: Path) -> None:
    original = read_lesson(file.parent, "")
    translated = read_lesson(file.parent, file.suffixes[0][1:])
    assert translated.title != original.title
    assert len(translated.steps) == len(original.steps)
    for ours, theirs in zip(original.steps, translated.steps, strict=True):
        where = f"step {ours.number}"
        assert (ours.kind, ours.scene, ours.commands, ours.exercise) == (
            theirs.kind, theirs.scene, theirs.commands, theirs.exercise,
        )  # fmt: skip
        assert [each.is_right for each in ours.options] == [each.is_right for each in theirs.options], where
        for claim in ours.claims:
            missing = set(NUMBER.findall(claim.words)) - set(NUMBER.findall(theirs.wording))
            assert not missing, f"{where}: {claim.words}"
        # Names in code are the same in every language.
        assert set(CODE.findall(theirs.text)) == set(CODE.findall(ours.text)) or not ours.claims, where


def test_the_language_is_named_by_two_letters(monkeypatch: pytest.MonkeyPatch) -> None:
    folder = find_lesson("1").folder
    for value, title in (
        ("pt_PT.UTF-8", "Conduzir"),
        ("PT", "Conduzir"),
        ("xx", "Drive"),
        ("", "Drive"),
        ("C", "Drive"),
    ):
        monkeypatch.setenv("KIT_LANG", value)
        assert read_lesson(folder).title == title, value
    assert chosen_language() == ""


def test_what_a_translation_leaves_out_is_reported_with_its_place(tmp_path: Path) -> None:
    folder = tmp_path / "01-drive"
    shutil.copytree(find_lesson("1").folder, folder)
    shutil.copy(lessons_folder() / "outcomes.yaml", tmp_path)
    file = folder / "lesson.pt.yaml"
    text = file.read_text()
    file.write_text(text[: text.index("  - title: Lê o robô")].replace("{file}", "o ficheiro"))
    with pytest.raises(WorldError) as caught:
        read_lesson(folder, "pt")
    assert "there are 8 steps" in str(caught.value)
    assert re.search(r"lesson\.pt\.yaml:\d+:\d+.*\{file\}", str(caught.value))


def test_questions_and_form_take_their_words_from_beside_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = shutil.copytree(find_lesson("1").folder, tmp_path / "01-drive")
    item = read_bank(tmp_path).items[0]
    options = "".join(f"      - {{text: opção {at}, feedback: porque {at}}}\n" for at in range(3))
    (folder / "quiz.pt.yaml").write_text(
        f"items:\n  - id: {item.id}\n    question: Qual?\n    options:\n{options}"
    )
    form = read_form()
    question = form.questions[0]
    (tmp_path / "form.yaml").write_text((lessons_folder() / "form.yaml").read_text())
    (tmp_path / "form.pt.yaml").write_text(f'words:\n  - {{of: "{question.text}", is: "Robôs"}}\n')
    monkeypatch.setenv("KIT_LANG", "pt")
    translated = read_bank(tmp_path).items[0]
    assert (translated.id, translated.question) == (item.id, "Qual?")
    assert [each.is_right for each in translated.options] == [each.is_right for each in item.options]
    assert read_form(tmp_path / "form.yaml").questions[0].text == "Robôs"
    assert read_form(tmp_path / "form.yaml").questions[0].id == question.id
