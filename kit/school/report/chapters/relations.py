"""Chapters on correlations between quantities, and on their sensitivity to single students."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from kit.arrays import FloatArray
from kit.document.blocks import (
    Block,
    Caution,
    Cell,
    CellStyle,
    Chapter,
    Column,
    ScatterPlot,
    Table,
    Text,
    p_value_text,
)
from kit.school.report.chapters.context import SCALE_BOUNDS, SHARE_BOUNDS, ReportContext
from kit.school.report.expertise import Sensitivity, correlation_sensitivity, difference_sensitivity
from kit.school.report.inference import (
    MAX_PERMUTED,
    SHUFFLE_COUNT,
    correlation,
    correlation_interval,
    correlation_test,
    fit_polynomial,
    non_blank,
    rank_correlation,
)
from kit.school.survey import QuestionPurpose, SurveyPhase


class StudentQuantity(NamedTuple):
    """A quantity of each student, with its bounds."""

    id: str
    title: str
    values: FloatArray
    bounds: tuple[float, float]


PAIRS: Final = (
    ("prior", "gained"),
    ("explanation", "gained"),
    ("score", "quiz"),
    ("difficulty", "quiz"),
    ("gained", "quiz"),
)
"""Pairs of quantities to correlate: those of the dissertation's plots, and the score."""

MIN_PAIRS: Final = 4


def student_quantities(context: ReportContext) -> dict[str, StudentQuantity]:
    """The quantities that this class has data for."""
    data = context.data
    found = (
        ("score", "expertise score", context.score, SCALE_BOUNDS),
        (
            "prior",
            "experience before",
            data.ratings.overall_means(QuestionPurpose.EXPERIENCE, SurveyPhase.BEFORE),
            SCALE_BOUNDS,
        ),
        (
            "gained",
            "learned, as rated",
            data.ratings.overall_means(QuestionPurpose.GAINED, SurveyPhase.AFTER),
            SCALE_BOUNDS,
        ),
        (
            "difficulty",
            "difficulty",
            data.ratings.overall_means(QuestionPurpose.DIFFICULTY, SurveyPhase.AFTER),
            SCALE_BOUNDS,
        ),
        (
            "explanation",
            "explanation",
            data.ratings.overall_means(QuestionPurpose.EXPLANATION, SurveyPhase.AFTER),
            SCALE_BOUNDS,
        ),
        ("quiz", "quiz score", data.quiz.scores if data.quiz.items else None, SHARE_BOUNDS),
    )
    return {
        name: StudentQuantity(name, title, values, bounds)
        for name, title, values, bounds in found
        if values is not None and len(non_blank(values))
    }


def relations_chapter(context: ReportContext) -> Chapter | None:
    """Correlations, with the plots they are of."""
    known = student_quantities(context)
    pairs = [
        (known[a], known[b])
        for a, b in PAIRS
        if a in known and b in known and _pair_count(known[a].values, known[b].values) >= MIN_PAIRS
    ]
    if not pairs:
        return None
    rows: tuple[tuple[Cell, ...], ...] = tuple(_correlation_row(a, b, context.seed) for a, b in pairs)
    heads = (
        Column("", CellStyle.TEXT),
        Column("n"),
        Column("r"),
        Column("95% of r"),
        Column("p", CellStyle.P_VALUE, 3),
        Column("rho"),
    )
    note = (
        f"r: Pearson's, rho: Spearman's. p by every order of up to {MAX_PERMUTED} students, else by {SHUFFLE_COUNT:,} "
        "random ones. What goes together need not cause one another."
    )
    blocks: list[Block] = [Table("relations", "Correlations", heads, rows, note)]
    for a, b in pairs:
        blocks.append(_scatter_plot(a, b))
        if (a.id, b.id) == ("prior", "gained"):
            blocks += _curvature_blocks(a, b)
    return Chapter("relations", "What goes together", tuple(blocks))


def _pair_count(x: FloatArray, y: FloatArray) -> int:
    return int((~(np.isnan(x) | np.isnan(y))).sum())


def _correlation_row(a: StudentQuantity, b: StudentQuantity, seed: int) -> tuple[Cell, ...]:
    n, r = _pair_count(a.values, b.values), correlation(a.values, b.values)
    test = correlation_test(a.values, b.values, np.random.default_rng(seed))
    rho = rank_correlation(a.values, b.values)
    return (f"{a.title} and {b.title}", n, r, correlation_interval(r, n), test.p_value, rho)


def _scatter_plot(a: StudentQuantity, b: StudentQuantity) -> ScatterPlot:
    both = ~(np.isnan(a.values) | np.isnan(b.values))
    line = fit_polynomial(a.values, b.values)
    return ScatterPlot(
        f"{a.id}-{b.id}",
        f"{b.title.capitalize()} by {a.title}",
        a.title,
        b.title,
        tuple(zip(a.values[both].tolist(), b.values[both].tolist(), strict=True)),
        a.bounds,
        b.bounds,
        None if line is None else (float(line[0]), float(line[1])),
    )


def _curvature_blocks(a: StudentQuantity, b: StudentQuantity) -> list[Block]:
    """States where a fitted parabola has its maximum, if it lies within the data."""
    curve = fit_polynomial(a.values, b.values, 2)
    if curve is None or curve[0] >= 0:
        return []
    top = -curve[1] / (2 * curve[0])
    if not non_blank(a.values).min() < top < non_blank(a.values).max():
        return []
    return [
        Text(
            f"A parabola through these points is highest at {top:.1f} on '{a.title}'. With so few students that is "
            "an idea to test, not a finding."
        )
    ]


def robustness_chapter(context: ReportContext) -> Chapter | None:
    """The results that a reader will quote, without each student in turn."""
    known = student_quantities(context)
    sensitivities: list[tuple[str, Sensitivity]] = []
    if context.division is not None:
        for name in ("quiz", "gained", "difficulty", "explanation"):
            if name in known:
                result = difference_sensitivity(known[name].values, context.division, context.seed)
                if result is not None:
                    sensitivities.append((f"experts minus beginners, {known[name].title}", result))
    for a, b in PAIRS:
        if a in known and b in known:
            result = correlation_sensitivity(known[a].values, known[b].values, context.seed)
            if result is not None:
                sensitivities.append((f"r of {known[a].title} and {known[b].title}", result))
    if not sensitivities:
        return None
    names = context.data.names
    rows: tuple[tuple[Cell, ...], ...] = tuple(
        (
            title,
            each.value,
            each.test.p_value,
            each.lowest.value,
            names[each.lowest.student],
            each.highest.value,
            names[each.highest.student],
        )
        for title, each in sensitivities
    )
    heads = (
        Column("result", CellStyle.TEXT),
        Column("value"),
        Column("p", CellStyle.P_VALUE, 3),
        Column("least"),
        Column("without", CellStyle.TEXT),
        Column("most"),
        Column("without", CellStyle.TEXT),
    )
    warnings = [_sensitivity_warning(title, each, names) for title, each in sensitivities if each.decisive]
    table = Table(
        "robustness",
        "The same without each student in turn (groups as they are)",
        heads,
        rows,
        "least, most: the smallest and greatest value, and who was left out for it.",
    )
    text = Text("No result changes its side of p = 0.05 without any one student.")
    return Chapter("robustness", "How much rests on one student", (table, *(warnings or (text,))))


def _sensitivity_warning(title: str, each: Sensitivity, names: Sequence[str]) -> Caution:
    """A result that is on the other side of the line without this student or that."""
    most = sorted(each.decisive, key=lambda one: -abs(one.test.p_value - each.test.p_value))
    shown = "; ".join(
        f"without {names[one.student]} it is {one.value:.2f} ({p_value_text(one.test.p_value)})"
        for one in most[:3]
    )
    more = f"; and so without {len(most) - 3} more" if len(most) > 3 else ""
    return Caution(
        f"{title}: {each.value:.2f}, {p_value_text(each.test.p_value)}; but {shown}{more}. One student decides on which side "
        "of 0.05 it lies."
    )
