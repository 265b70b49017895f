"""The teacher's guide says of each lesson what it teaches and what goes wrong, and fits a terminal."""

from __future__ import annotations

import pytest
from click.testing import CliRunner

from kit.cli import main
from kit.school.lessons.reading import lesson_names
from kit.school.lessons.teachers_guide import WIDTH, misconceptions, teachers_guide
from tests.kit_content import kit_lesson


@pytest.fixture(scope="module")
def guide() -> str:
    return teachers_guide()


def joined(text: str) -> str:
    return " ".join(text.split())


@pytest.mark.long
def test_every_lesson_every_outcome_and_every_mistake_is_in_it(guide: str) -> None:
    text = joined(guide)
    for name in lesson_names():
        lesson = kit_lesson(name)
        assert joined(f"{lesson.title}, {lesson.minutes} minutes") in text
        assert [each for each in lesson.outcomes if joined(each) not in text] == []
        assert [each.name for each in lesson.exercises if f"`{each.name}`" not in text] == []
    assert [each for each in misconceptions() if joined(each.why) not in text] == []


def test_it_fits_a_terminal(guide: str) -> None:
    assert [line for line in guide.splitlines() if len(line) > WIDTH and " " in line.strip("- ")] == []


def test_one_lesson_by_its_number_and_none_that_there_is_not() -> None:
    done = CliRunner().invoke(main, ["class", "guide", "1"])
    assert done.exit_code == 0, done.output
    assert done.output.count("\n### ") + done.output.startswith("### ") == 1
    assert CliRunner().invoke(main, ["class", "guide", "no-such-lesson"]).exit_code == 2
