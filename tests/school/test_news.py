"""What is new is told once on each screen, and on no screen that does not exist."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.school import news
from kit.school.news import NEWS, take_news
from kit.school.progress import ProgressJournal
from kit.tui.screens.lessons import LessonsScreen
from kit.tui.screens.levels import LevelsScreen
from kit.tui.screens.start import StartScreen

HEADING: int = 26
"""Columns for a line beside the counts of lessons at 80 columns."""


def test_a_line_is_told_once_and_the_next_update_tells_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with ProgressJournal(tmp_path) as journal:
        for screen, (_, line) in NEWS.items():
            assert take_news(journal, screen) == f"New: {line}"
            assert len(f" New: {line}") < 80
            assert take_news(journal, screen) == ""
    with ProgressJournal(tmp_path) as journal:  # nor after a restart
        assert {take_news(journal, screen) for screen in NEWS} == {""}
        monkeypatch.setattr(news, "NEWS", {**NEWS, "levels": ("9.9.9", "something.")})
        assert take_news(journal, "levels") == "New: something."
        assert {take_news(journal, screen) for screen in NEWS} == {""}


def test_a_line_that_cannot_be_kept_is_not_told(tmp_path: Path) -> None:
    journal = ProgressJournal(tmp_path)
    journal.close()
    assert take_news(journal, "levels") == ""


def test_every_line_belongs_to_a_screen_and_fits_beside_its_heading() -> None:
    screens = {each.screen_actions.name for each in (StartScreen, LevelsScreen, LessonsScreen)}
    assert screens == set(NEWS)
    assert all(len(line) <= 74 for _, line in NEWS.values())
    assert len(NEWS["lessons"][1]) <= HEADING
