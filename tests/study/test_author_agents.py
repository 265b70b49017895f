"""What the author's published agents reach here: the file that says so, and its table."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.document.layout import lines_of
from kit.study.author_agents import (
    AGENTS_FILE,
    AuthorAgentsError,
    author_agents_table,
    read_author_agents,
)
from kit.study.printed_tables import printed_table


def test_each_result_says_what_drove_and_where_and_its_print_is_the_table_s() -> None:
    found = read_author_agents()
    assert len(found) >= 10
    for each in found:
        assert each.where
        assert each.success is not None
    straight = printed_table("4.1")
    for each in (each for each in found if each.table == "4.1"):
        assert each.printed_success == straight.cell("straight", "acc")
        assert each.printed_adjacency == straight.cell("straight", "adj")
    assert "Recorded outside the kit" in " ".join(lines_of([author_agents_table()]))


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [("0.77,0.21,0,", "0.77,x,0,", 4), (",100,full", ",,full", 4), ("agent,", "agents,", 1)],
)
def test_a_mistake_is_told_with_its_line(tmp_path: Path, old: str, new: str, line: int) -> None:
    text = AGENTS_FILE.read_text()
    assert old in text
    file = tmp_path / "agents.csv"
    file.write_text(text.replace(old, new, 1))
    with pytest.raises(AuthorAgentsError, match=f"line {line}"):
        read_author_agents(file)
