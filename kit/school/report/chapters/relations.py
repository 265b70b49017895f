"""What goes together, and how much of it rests on one student."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from kit.kernels.arrays import Float64Array
from kit.school.report.chapters.setting import SCALE, SHARE, Setting
from kit.school.report.document import (
    CellStyle,
    ReportBlock,
    ReportChapter,
    ReportTable,
    ReportText,
    ReportWarning,
    ScatterPlot,
    TableCell,
    TableColumn,
    p_value_text,
)
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
from kit.school.report.robustness import Sensitivity, correlation_sensitivity, difference_sensitivity
from kit.school.survey.questions import QuestionPurpose, SurveyPhase


class Quantity(NamedTuple):
    """Something that is known of each student."""

    id: str
    title: str
    values: Float64Array
    bounds: tuple[float, float]


PAIRS: Final = (
    ("prior", "gained"),
    ("explanation", "gained"),
    ("score", "quiz"),
    ("difficulty", "quiz"),
    ("gained", "quiz"),
)
"""What is compared with what: the dissertation's plots, and the score."""

FEWEST: Final = 4


def quantities(setting: Setting) -> dict[str, Quantity]:
    """Those that this class has."""
    data = setting.data
    found = (
        ("score", "expertise score", setting.score, SCALE),
        (
            "prior",
            "experience before",
            data.ratings.overall(QuestionPurpose.EXPERIENCE, SurveyPhase.BEFORE),
            SCALE,
        ),
        (
            "gained",
            "learned, as rated",
            data.ratings.overall(QuestionPurpose.GAINED, SurveyPhase.AFTER),
            SCALE,
        ),
        (
            "difficulty",
            "difficulty",
            data.ratings.overall(QuestionPurpose.DIFFICULTY, SurveyPhase.AFTER),
            SCALE,
        ),
        (
            "explanation",
            "explanation",
            data.ratings.overall(QuestionPurpose.EXPLANATION, SurveyPhase.AFTER),
            SCALE,
        ),
        ("quiz", "quiz score", data.quiz.score if data.quiz.items else None, SHARE),
    )
    return {
        name: Quantity(name, title, values, bounds)
        for name, title, values, bounds in found
        if values is not None and len(non_blank(values))
    }


def relations(setting: Setting) -> ReportChapter | None:
    """Correlations, with the plots they are of."""
    known = quantities(setting)
    pairs = [
        (known[a], known[b])
        for a, b in PAIRS
        if a in known and b in known and _shared(known[a].values, known[b].values) >= FEWEST
    ]
    if not pairs:
        return None
    rows: tuple[tuple[TableCell, ...], ...] = tuple(_row(a, b, setting.seed) for a, b in pairs)
    heads = (
        TableColumn("", CellStyle.TEXT),
        TableColumn("n"),
        TableColumn("r"),
        TableColumn("95% of r"),
        TableColumn("p", CellStyle.CHANCE, 3),
        TableColumn("rho"),
    )
    note = (
        f"r: Pearson's, rho: Spearman's. p by every order of up to {MAX_PERMUTED} students, else by {SHUFFLE_COUNT:,} "
        "random ones. What goes together need not cause one another."
    )
    blocks: list[ReportBlock] = [ReportTable("relations", "Correlations", heads, rows, note)]
    for a, b in pairs:
        blocks.append(_scatter(a, b))
        if (a.id, b.id) == ("prior", "gained"):
            blocks += _bend(a, b)
    return ReportChapter("relations", "What goes together", tuple(blocks))


def _shared(x: Float64Array, y: Float64Array) -> int:
    return int((~(np.isnan(x) | np.isnan(y))).sum())


def _row(a: Quantity, b: Quantity, seed: int) -> tuple[TableCell, ...]:
    n, r = _shared(a.values, b.values), correlation(a.values, b.values)
    chance = correlation_test(a.values, b.values, np.random.default_rng(seed))
    rho = rank_correlation(a.values, b.values)
    return (f"{a.title} and {b.title}", n, r, correlation_interval(r, n), chance.p_value, rho)


def _scatter(a: Quantity, b: Quantity) -> ScatterPlot:
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


def _bend(a: Quantity, b: Quantity) -> list[ReportBlock]:
    """Whether a parabola has its top among the students."""
    curve = fit_polynomial(a.values, b.values, 2)
    if curve is None or curve[0] >= 0:
        return []
    top = -curve[1] / (2 * curve[0])
    if not non_blank(a.values).min() < top < non_blank(a.values).max():
        return []
    return [
        ReportText(
            f"A parabola through these points is highest at {top:.1f} on '{a.title}'. With so few students that is "
            "an idea to test, not a finding."
        )
    ]


def robustness(setting: Setting) -> ReportChapter | None:
    """The results that a reader will quote, without each student in turn."""
    known = quantities(setting)
    found: list[tuple[str, Sensitivity]] = []
    if setting.division is not None:
        for name in ("quiz", "gained", "difficulty", "explanation"):
            if name in known:
                result = difference_sensitivity(known[name].values, setting.division, setting.seed)
                if result is not None:
                    found.append((f"experts minus beginners, {known[name].title}", result))
    for a, b in PAIRS:
        if a in known and b in known:
            result = correlation_sensitivity(known[a].values, known[b].values, setting.seed)
            if result is not None:
                found.append((f"r of {known[a].title} and {known[b].title}", result))
    if not found:
        return None
    names = setting.data.names
    rows: tuple[tuple[TableCell, ...], ...] = tuple(
        (
            title,
            each.value,
            each.test.p_value,
            each.lowest.value,
            names[each.lowest.student],
            each.highest.value,
            names[each.highest.student],
        )
        for title, each in found
    )
    heads = (
        TableColumn("result", CellStyle.TEXT),
        TableColumn("value"),
        TableColumn("p", CellStyle.CHANCE, 3),
        TableColumn("least"),
        TableColumn("without", CellStyle.TEXT),
        TableColumn("most"),
        TableColumn("without", CellStyle.TEXT),
    )
    cautions = [_caution(title, each, names) for title, each in found if each.decisive]
    table = ReportTable(
        "robustness",
        "The same without each student in turn (groups as they are)",
        heads,
        rows,
        "least, most: the smallest and greatest value, and who was left out for it.",
    )
    text = ReportText("No result changes its side of p = 0.05 without any one student.")
    return ReportChapter("robustness", "How much rests on one student", (table, *(cautions or (text,))))


def _caution(title: str, each: Sensitivity, names: Sequence[str]) -> ReportWarning:
    """A result that is on the other side of the line without this student or that."""
    most = sorted(each.decisive, key=lambda one: -abs(one.test.p_value - each.test.p_value))
    shown = "; ".join(
        f"without {names[one.student]} it is {one.value:.2f} ({p_value_text(one.test.p_value)})"
        for one in most[:3]
    )
    more = f"; and so without {len(most) - 3} more" if len(most) > 3 else ""
    return ReportWarning(
        f"{title}: {each.value:.2f}, {p_value_text(each.test.p_value)}; but {shown}{more}. One student decides on which side "
        "of 0.05 it lies."
    )
