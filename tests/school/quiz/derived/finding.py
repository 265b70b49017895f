"""What a derivation finds out, to be compared with an item's options."""

from __future__ import annotations

import re
from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass
from pathlib import Path

from kit.school.quiz.items import QuizItem


@dataclass(frozen=True, slots=True)
class Finding:
    """What the kit did, and what each option, by its text, says that it does: the right one says the same."""

    truth: Hashable
    means: Mapping[str, Hashable]


Derivation = Callable[[QuizItem, Path], Finding]
"""Gets the item and an empty folder."""


def number(text: str) -> float:
    """The first number in a text."""
    found = re.search(r"-?\d+(\.\d+)?", text)
    assert found is not None, text
    return float(found[0])


def numbers_of(item: QuizItem) -> list[float]:
    """What the options say, where each is a number."""
    return [number(option.text) for option in item.options]


def nearest(item: QuizItem, measured: float, tolerance: float) -> Finding:
    """Options that are numbers: the one that is meant lies within the tolerance of what was measured."""
    means = {option.text: number(option.text) for option in item.options}
    near = [value for value in means.values() if abs(value - measured) <= tolerance]
    assert len(near) == 1, (measured, means)
    return Finding(near[0], means)
