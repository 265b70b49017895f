"""Diagrams with joined lines."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import yaml

from kit.document.glyphs import diagram_lines

LESSONS = Path(__file__).parents[2] / "lessons"


def test_a_diagram_of_the_lessons_keeps_its_size_and_its_words() -> None:
    diagrams = [
        step["picture"].splitlines()
        for file in LESSONS.glob("*/lesson.yaml")
        for step in yaml.safe_load(file.read_text("utf-8"))["steps"]
        if "picture" in step
    ]
    assert diagrams
    for lines in diagrams:
        drawn = diagram_lines(lines)
        assert [len(line) for line in drawn] == [len(line) for line in lines]
        for before, after in zip(lines, drawn, strict=True):
            kept, words = (
                [each for each in re.findall(r"\w+", text) if each != "v"] for text in (before, after)
            )
            assert kept == words


def test_a_box_with_an_arrow_has_joined_lines_and_a_head() -> None:
    drawn = diagram_lines(["+---+", "| a |-->", "+-+-+", "  |", "  v"])
    assert drawn == ["┌───┐", "│ a │──▶", "└─┬─┘", "  │", "  ▼"]


@pytest.mark.parametrize("line", ["x - y", "-25.1", "a-b", "1*3^7 + 1", "#..G+.#", "a > b", "have v"])
def test_what_is_no_line_stays(line: str) -> None:
    assert diagram_lines([line]) == [line]
