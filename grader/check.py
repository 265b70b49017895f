"""A check: a measure, the anchors between which it earns points, and the feedback for lost points."""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from grader.scoring import Anchors
from kit.plain_text import format_percent

Faults = Callable[[Any, Any], Iterator[str]]
"""(the evidence's content, params) -> each thing that is wrong, in words."""


@dataclass(frozen=True, slots=True)
class NoParams:
    """The params of a check that has none."""


@dataclass(frozen=True, slots=True)
class Check:
    """One way to measure evidence."""

    name: str
    measure: Callable[[Any, Any], float]
    """(evidence, params) -> a number; NaN earns nothing."""
    anchors: Anchors
    """The default anchors."""
    unit: str
    """``%`` for a share."""
    params: type[Any]
    """A frozen dataclass; the types of its defaults set what may be given: numbers, texts, lists of texts."""
    feedback: str
    """``{actual}``, ``{full}``, ``{where}``, ``{passed}``, ``{count}`` are filled in."""
    words: tuple[str, str] | None
    """For a measure that is 0 or 1: the words for both."""
    faults: Faults | None = None
    """None where the feedback says everything."""
    is_explained: bool = False
    """Whether what the evidence explains is enough: a student then reads no measure beside it."""

    def format(self, measure: float, *, beside: float = 1.0) -> str:
        """Formats a measure in words, or as a number with its unit. A share reads unlike ``beside``, that it is compared with,
        unless it is equal to it."""
        if self.words is not None:
            return self.words[measure >= 1.0]
        if math.isnan(measure):
            return "not measured"
        if self.unit == "%":
            return format_percent(measure, beside=beside)
        number = f"{measure:.2f}".rstrip("0").rstrip(".") if abs(measure) < 1e6 else f"{measure:g}"
        is_plural = self.unit.isalpha() and len(self.unit) > 1 and self.unit.endswith("s")
        unit = self.unit[:-1] if is_plural and number == "1" else self.unit
        return f"{number} {unit}".strip()


def check(
    *,
    none: float,
    full: float,
    unit: str = "",
    params: type[Any] = NoParams,
    words: tuple[str, str] | None = None,
    faults: Faults | None = None,
    is_explained: bool = False,
) -> Callable[[Callable[[Any, Any], float]], Check]:
    """Makes a check of a function; its docstring is the feedback."""

    def make(function: Callable[[Any, Any], float]) -> Check:
        text = inspect.getdoc(function) or ""
        return Check(
            name=function.__name__,
            measure=function,
            anchors=Anchors(none, full),
            unit=unit,
            params=params,
            feedback=" ".join(text.split()),
            words=words,
            faults=faults,
            is_explained=is_explained,
        )

    return make
