"""What a check is: a measure, the anchors it is marked between, and a sentence for those who miss."""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from grader.scoring import Anchors

Faults = Callable[[Any, Any], Iterator[str]]
"""(the evidence's content, params) -> each thing that is wrong, in words."""


@dataclass(frozen=True, slots=True)
class NoParams:
    """A check that needs no more than what was recorded."""


@dataclass(frozen=True, slots=True)
class Check:
    """One way to look at a recording."""

    name: str
    measure: Callable[[Any, Any], float]
    """(evidence, params) -> a number; NaN earns nothing."""
    anchors: Anchors
    """Unless the assignment gives others."""
    unit: str
    """``%`` for a share."""
    params: type[Any]
    """A frozen dataclass whose defaults say what may be given: numbers, texts, lists of texts."""
    feedback: str
    """``{actual}``, ``{full}``, ``{where}``, ``{passed}``, ``{count}`` are filled in."""
    words: tuple[str, str] | None
    """For a yes or no: what 0 and 1 mean."""
    faults: Faults | None = None
    """None where the feedback says all."""

    def format(self, measure: float) -> str:
        """A measure in words, or with its unit."""
        if self.words is not None:
            return self.words[measure >= 1.0]
        if math.isnan(measure):
            return "not measured"
        if self.unit == "%":
            measure *= 100.0
        number = f"{measure:.2f}".rstrip("0").rstrip(".") if abs(measure) < 1e6 else f"{measure:g}"
        return f"{number} {self.unit}".strip()


def check(
    *,
    none: float,
    full: float,
    unit: str = "",
    params: type[Any] = NoParams,
    words: tuple[str, str] | None = None,
    faults: Faults | None = None,
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
        )

    return make
