"""What is painted again of a row of text is what looks different, and no less."""

from __future__ import annotations

import itertools
import random

from kit.document.rows import Row, row
from kit.tui.widgets.text_rows import LONGEST_GAP, changed_spans

STYLES = ("", "dim", "bold")


def cells(parts: Row) -> list[tuple[str, str]]:
    return [(char, style) for text, style in parts for char in text]


def random_row(chance: random.Random, length: int) -> Row:
    return row(*((chance.choice("ab▃°"), chance.choice(STYLES)) for _ in range(length)))


def test_painting_the_spans_makes_the_new_row_of_the_old_one() -> None:
    chance = random.Random(4)
    for _ in range(200):
        length = chance.randrange(1, 60)
        old = random_row(chance, length)
        changed = set(chance.sample(range(length), chance.randrange(length + 1)))
        new = row(*(("z", "warn") if i in changed else part for i, part in enumerate(old)))
        painted, spans = cells(old), changed_spans(old, new)
        for start, stop in spans:
            painted[start:stop] = cells(new)[start:stop]
        assert painted == cells(new)
        assert all(second - first > LONGEST_GAP for (_, first), (second, _) in itertools.pairwise(spans))
        assert {column for span in spans for column in (span[0], span[1] - 1)} <= changed


def test_a_row_of_another_length_or_with_wide_characters_is_painted_whole() -> None:
    assert changed_spans(row("speed 1"), row("speed")) == [(0, 7)]
    assert changed_spans(row("ab字"), row("ac字")) == [(0, 4)]
    assert changed_spans(row("same"), row("same")) == []
