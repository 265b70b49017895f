"""A program in colours says what it says: no character is lost, and Python's words have their styles."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.controllers import kit_controllers
from kit.tui.widgets.program_colours import LANGUAGES, MOST_COLOURED, coloured_rows
from kit.tui.widgets.text_rows import LOOKS
from tests.tui.lesson_stage import row_text

FILES = [each.file for each in kit_controllers()]


@pytest.mark.parametrize("file", FILES, ids=lambda each: each.stem)
def test_every_line_is_whole_and_every_style_is_known(file: Path) -> None:
    lines = file.read_text(encoding="utf-8").splitlines()
    rows = coloured_rows(lines, LANGUAGES[file.suffix])
    assert [row_text(each) for each in rows] == lines
    assert {style for each in rows for _, style in each} <= set(LOOKS)
    assert any(("import", "keyword") in each for each in rows) or len("\n".join(lines)) > MOST_COLOURED


def test_without_a_language_and_in_a_long_text_nothing_is_coloured() -> None:
    assert coloured_rows(["import os", ""], None) == [(("import os", ""),), ()]
    long = ["import os"] * MOST_COLOURED
    assert {style for each in coloured_rows(long, "python") for _, style in each} == {""}
    assert row_text(coloured_rows(['a = "', "b"], "python")[1]) == "b"  # a text that does not end
