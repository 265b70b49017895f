"""What goes together, and how much of it rests on one student."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from kit.kernels.arrays import Float64Array
from kit.school.report.chapters.setting import SCALE, SHARE, Setting
from kit.school.report.document import (
    Block,
    Caution,
    Cell,
    Chapter,
    Column,
    Scatter,
    Style,
    Table,
    Text,
    chance_text,
)
from kit.school.report.inference import (
    MOST_ORDERS,
    SHUFFLES,
    correlation,
    correlation_interval,
    correlation_test,
    present,
    rank_correlation,
    trend,
)
from kit.school.report.robustness import Sensitivity, of_correlation, of_difference
from kit.school.survey.questions import Phase, Purpose


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
        ("prior", "experience before", data.ratings.overall(Purpose.EXPERIENCE, Phase.BEFORE), SCALE),
        ("gained", "learned, as rated", data.ratings.overall(Purpose.GAINED, Phase.AFTER), SCALE),
        ("difficulty", "difficulty", data.ratings.overall(Purpose.DIFFICULTY, Phase.AFTER), SCALE),
        ("explanation", "explanation", data.ratings.overall(Purpose.EXPLANATION, Phase.AFTER), SCALE),
        ("quiz", "quiz score", data.quiz.score if data.quiz.items else None, SHARE),
    )
    return {
        name: Quantity(name, title, values, bounds)
        for name, title, values, bounds in found
        if values is not None and len(present(values))
    }


def relations(setting: Setting) -> Chapter | None:
    """Correlations, with the plots they are of."""
    known = quantities(setting)
    pairs = [
        (known[a], known[b])
        for a, b in PAIRS
        if a in known and b in known and _shared(known[a].values, known[b].values) >= FEWEST
    ]
    if not pairs:
        return None
    rows: tuple[tuple[Cell, ...], ...] = tuple(_row(a, b, setting.seed) for a, b in pairs)
    heads = (
        Column("", Style.TEXT),
        Column("n"),
        Column("r"),
        Column("95% of r"),
        Column("p", Style.CHANCE, 3),
        Column("rho"),
    )
    note = (
        f"r: Pearson's, rho: Spearman's. p by every order of up to {MOST_ORDERS} students, else by {SHUFFLES:,} "
        "random ones. What goes together need not cause one another."
    )
    blocks: list[Block] = [Table("relations", "Correlations", heads, rows, note)]
    for a, b in pairs:
        blocks.append(_scatter(a, b))
        if (a.id, b.id) == ("prior", "gained"):
            blocks += _bend(a, b)
    return Chapter("relations", "What goes together", tuple(blocks))


def _shared(x: Float64Array, y: Float64Array) -> int:
    return int((~(np.isnan(x) | np.isnan(y))).sum())


def _row(a: Quantity, b: Quantity, seed: int) -> tuple[Cell, ...]:
    n, r = _shared(a.values, b.values), correlation(a.values, b.values)
    chance = correlation_test(a.values, b.values, np.random.default_rng(seed))
    rho = rank_correlation(a.values, b.values)
    return (f"{a.title} and {b.title}", n, r, correlation_interval(r, n), chance.p, rho)


def _scatter(a: Quantity, b: Quantity) -> Scatter:
    both = ~(np.isnan(a.values) | np.isnan(b.values))
    line = trend(a.values, b.values)
    return Scatter(
        f"{a.id}-{b.id}",
        f"{b.title.capitalize()} by {a.title}",
        a.title,
        b.title,
        tuple(zip(a.values[both].tolist(), b.values[both].tolist(), strict=True)),
        a.bounds,
        b.bounds,
        None if line is None else (float(line[0]), float(line[1])),
    )


def _bend(a: Quantity, b: Quantity) -> list[Block]:
    """Whether a parabola has its top among the students."""
    curve = trend(a.values, b.values, 2)
    if curve is None or curve[0] >= 0:
        return []
    top = -curve[1] / (2 * curve[0])
    if not present(a.values).min() < top < present(a.values).max():
        return []
    return [
        Text(
            f"A parabola through these points is highest at {top:.1f} on '{a.title}'. With so few students that is "
            "an idea to test, not a finding."
        )
    ]


def robustness(setting: Setting) -> Chapter | None:
    """The results that a reader will quote, without each student in turn."""
    known = quantities(setting)
    found: list[tuple[str, Sensitivity]] = []
    if setting.division is not None:
        for name in ("quiz", "gained", "difficulty", "explanation"):
            if name in known:
                result = of_difference(known[name].values, setting.division, setting.seed)
                if result is not None:
                    found.append((f"experts minus beginners, {known[name].title}", result))
    for a, b in PAIRS:
        if a in known and b in known:
            result = of_correlation(known[a].values, known[b].values, setting.seed)
            if result is not None:
                found.append((f"r of {known[a].title} and {known[b].title}", result))
    if not found:
        return None
    names = setting.data.names
    rows: tuple[tuple[Cell, ...], ...] = tuple(
        (
            title,
            each.value,
            each.chance.p,
            each.least.value,
            names[each.least.student],
            each.greatest.value,
            names[each.greatest.student],
        )
        for title, each in found
    )
    heads = (
        Column("result", Style.TEXT),
        Column("value"),
        Column("p", Style.CHANCE, 3),
        Column("least"),
        Column("without", Style.TEXT),
        Column("most"),
        Column("without", Style.TEXT),
    )
    cautions = [_caution(title, each, names) for title, each in found if each.turning]
    table = Table(
        "robustness",
        "The same without each student in turn (groups as they are)",
        heads,
        rows,
        "least, most: the smallest and greatest value, and who was left out for it.",
    )
    text = Text("No result changes its side of p = 0.05 without any one student.")
    return Chapter("robustness", "How much rests on one student", (table, *(cautions or (text,))))


def _caution(title: str, each: Sensitivity, names: Sequence[str]) -> Caution:
    """A result that is on the other side of the line without this student or that."""
    most = sorted(each.turning, key=lambda one: -abs(one.chance.p - each.chance.p))
    shown = "; ".join(
        f"without {names[one.student]} it is {one.value:.2f} ({chance_text(one.chance.p)})"
        for one in most[:3]
    )
    more = f"; and so without {len(most) - 3} more" if len(most) > 3 else ""
    return Caution(
        f"{title}: {each.value:.2f}, {chance_text(each.chance.p)}; but {shown}{more}. One student decides on which side "
        "of 0.05 it lies."
    )
