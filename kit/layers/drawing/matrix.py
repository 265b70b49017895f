"""The pairs and lasers of a case as a matrix of marks."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from kit.layers.drawing.spans import DrawingLine, DrawingSpan, DrawingStyle
from kit.layers.requirements import ContactRequirement, LayerCase


def draw_matrix(
    case: LayerCase,
    *,
    struck: Collection[ContactRequirement] = (),
    group: Collection[str] = (),
    cursor: tuple[int, int] | None = None,
) -> list[DrawingLine]:
    """Every pair and every laser in one table, which no number of entities tangles.

    ``#`` must collide, ``x`` the same and struck, ``~`` left open, ``.`` must not; in a laser's row ``#`` must
    see, ``~`` may, ``.`` must not. A name in the ``group`` is marked by ``*``. ``cursor``: row and column of a mark
    that is to stand out; the lasers' rows follow the entities'.
    """
    numbers = [f"{i + 1}" for i in range(len(case.names))]
    digits = max((len(number) for number in numbers), default=1)
    wide = max((len(name) for name in (*case.names, *case.laser)), default=0)
    wide = min(wide, max(8, 76 - digits - 2 * len(numbers)))
    step = 2 if digits == 1 or wide + digits + 2 * len(numbers) <= 76 else 1
    lines: list[DrawingLine] = []
    for place in range(digits):
        head = "".join(number.rjust(digits)[place].ljust(step) for number in numbers)
        lines.append((DrawingSpan(" " * (wide + digits + 3) + head, "text"),))
    at_row, at_column = cursor or (None, None)
    for i, a in enumerate(case.names):
        label = f"{numbers[i].rjust(digits)}{'*' if a in group else ' '}{a[:wide].ljust(wide)}  "
        marks = [_pair_mark(case, a, b, struck) for b in case.names[: i + 1]]
        style: DrawingStyle = "group" if a in group else "map" if case.by_name[a].kind == "map" else "body"
        lines.append(
            (DrawingSpan(label, style), *_mark_spans(marks, "edge", step, at_column if i == at_row else None))
        )
    for i, laser in enumerate(case.lasers, start=len(case.names)):
        marks = [{"sees": "#", "either": "~", "blind": "."}[laser.sighting(name)] for name in case.names]
        label = f"{' ' * digits}>{laser.name[:wide].ljust(wide)}  "
        lines.append(
            (
                DrawingSpan(label, "laser"),
                *_mark_spans(marks, "beam", step, at_column if i == at_row else None),
            )
        )
    return lines


def _mark_spans(marks: Sequence[str], style: DrawingStyle, step: int, cursor: int | None) -> DrawingLine:
    """A row of the matrix, ``step`` characters to each mark, the one at the cursor apart."""
    text = "".join(mark.ljust(step) for mark in marks)
    if cursor is None:
        return (DrawingSpan(text, style),)
    at = cursor * step
    return DrawingSpan(text[:at], style), DrawingSpan(text[at], "cursor"), DrawingSpan(text[at + 1 :], style)


def _pair_mark(case: LayerCase, a: str, b: str, struck: Collection[ContactRequirement]) -> str:
    relation = case.relation(a, b)
    if a == b:
        return {"collide": "#", "apart": ".", "either": "\\"}[relation]
    if relation == "collide" and ContactRequirement(a, b) in struck:
        return "x"
    return {"collide": "#", "apart": ".", "either": "~"}[relation]
