"""Lessons in other languages: the same structure, the same numbers, and no gap."""

from __future__ import annotations

import ast
import re
import shutil
from pathlib import Path

import pytest
import yaml

from grader.reading import read_assignment
from kit.school.form_reading import read_form
from kit.school.lessons.checking import is_untouched
from kit.school.lessons.lesson_session import LessonSession
from kit.school.lessons.reading import find_lesson, lessons_folder, read_lesson
from kit.school.lessons.translation import chosen_language, missing_translation_text, translation_of
from kit.school.progress import ProgressJournal
from kit.school.quiz.items import read_bank
from kit.workspace import open_workspace
from kit.world.problems import WorldError
from tests.exercise_checks import check_exercise

TRANSLATIONS = sorted(lessons_folder().glob("*/lesson.??.yaml"))
TRANSLATED = sorted({(file.parent, file.suffixes[0][1:]) for file in TRANSLATIONS})
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


@pytest.mark.parametrize(("folder", "language"), TRANSLATED, ids=lambda each: getattr(each, "name", each))
def test_a_translated_lesson_is_translated_whole(
    folder: Path, language: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    originals = [each for each in read_bank().items if each.lesson == folder.name]
    monkeypatch.setenv("KIT_LANG", language)
    for ours, theirs in zip(
        originals, (each for each in read_bank().items if each.lesson == folder.name), strict=True
    ):
        assert theirs.question != ours.question, ours.id
        assert [each.is_right for each in theirs.options] == [each.is_right for each in ours.options]
        for option, translated in zip(ours.options, theirs.options, strict=True):
            assert set(NUMBER.findall(option.text)) == set(NUMBER.findall(translated.text)), ours.id
            assert translated.feedback != option.feedback, ours.id
    for exercise in read_lesson(folder, language).exercises:
        for criterion in read_assignment(exercise.folder).criteria:
            hints = (*criterion.hints, *(each.hint for each in criterion.mistakes))
            for text in (criterion.title, *hints):
                said = exercise.words[" ".join(text.split())]
                assert set(NUMBER.findall(text)) == set(NUMBER.findall(said)), f"{exercise.name}: {said}"
        starter = exercise.folder / f"starter{Path(exercise.file).suffix}"
        if starter.suffix == ".py":
            translated_file = translation_of(starter, language)
            assert translated_file is not None, exercise.name
            assert ast.dump(without_docstrings(starter)) == ast.dump(without_docstrings(translated_file))
        elif starter.suffix == ".yaml":
            translated_file = translation_of(starter, language)
            assert translated_file is not None, exercise.name
            assert yaml.safe_load(translated_file.read_text()) == yaml.safe_load(starter.read_text())


def without_docstrings(file: Path) -> ast.AST:
    tree = ast.parse(file.read_text())
    for each in ast.walk(tree):
        body = getattr(each, "body", None)
        if isinstance(body, list):
            body[:] = [
                line
                for line in body
                if not (isinstance(line, ast.Expr) and isinstance(line.value, ast.Constant))
            ]
    return tree


def test_the_form_is_translated_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    original = read_form()
    monkeypatch.setenv("KIT_LANG", "pt")
    form = read_form()
    assert form.title != original.title
    same = {"ROS 1", "ROS 2"}
    for ours, theirs in zip(original.questions, form.questions, strict=True):
        assert theirs.options == ours.options
        pairs = [*zip(ours.options, theirs.shown_options, strict=True)]
        pairs += [
            (getattr(ours, name), getattr(theirs, name)) for name in ("text", "group_text", "low", "high")
        ]
        assert all(said != of or of in same or not of for of, said in pairs), ours.id


def test_hints_and_titles_of_a_check_are_in_the_language_of_the_lesson(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("KIT_LANG", "pt")
    lesson = find_lesson("1")
    exercise = next(each for each in lesson.exercises if each.name == "readout")
    with ProgressJournal(tmp_path) as journal:
        session = LessonSession(lesson, journal, open_workspace(tmp_path))
        file = session.install(exercise)
        assert "Escreve cada resposta" in file.read_text()
        assert is_untouched(file, exercise)
        report = check_exercise(exercise, file)
        assert report.criteria[0].title == "Quem fala com quem"
        assert "Em que tópico o diz o teclado?" in report.criteria[0].rationale
        session.record(exercise, report)
        hint = session.next_hint(exercise)
    assert hint is not None
    assert hint.text.startswith("Abre uma condução")
    monkeypatch.setenv("KIT_LANG", "")
    assert is_untouched(file, exercise)


def test_a_lesson_without_a_translation_says_which_language_is_missing() -> None:
    lessons = {
        name: read_lesson(lessons_folder() / name, "pt") for name in ("01-drive", "13-potential-fields")
    }
    assert [each.missing_language for each in lessons.values()] == ["", "pt"]
    assert read_lesson(lessons_folder() / "13-potential-fields", "en").missing_language == ""
    assert missing_translation_text("") == ""
    assert "pt" in missing_translation_text("pt")


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
