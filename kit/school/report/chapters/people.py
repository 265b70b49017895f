"""Who is in the class, what they knew before, and how the class is cut into beginners and experts."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from kit.school.report.chapters.setting import SCALE, Setting, cautions_of, means_table, title_of
from kit.school.report.document import Block, Caution, Cell, Chapter, Column, Histogram, Style, Table, Text
from kit.school.report.expertise import effective_weights
from kit.school.report.inference import present, summary
from kit.school.report.measures import Measure
from kit.school.survey.questions import Phase, Purpose

BINS = tuple(float(edge) for edge in np.linspace(*SCALE, 7))


def people(setting: Setting, files: int) -> Chapter:
    """The roll: how many, what they filled in, what was wrong with their files."""
    data = setting.data
    quiz = [
        name
        for i, name in enumerate(data.names)
        if any(row[i] is not None for row in data.quiz.replies.values())
    ]
    blocks: list[Block] = [Caution(text) for text in data.cautions]
    rows: tuple[tuple[Cell, ...], ...] = (
        ("files", files),
        ("students", len(data.names)),
        ("form before", _answered(setting, Phase.BEFORE)),
        ("form after", _answered(setting, Phase.AFTER)),
        ("form quizzed", _answered(setting, Phase.QUIZZED)),
        ("quiz", len(quiz)),
        ("lessons", sum(bool(work) for work in data.work)),
    )
    blocks.append(Table("class", "Who is in this report", (Column("", Style.TEXT), Column("n")), rows))
    counted: tuple[tuple[Cell, ...], ...] = tuple(
        (question.text, word, count)
        for question, _, counts in data.counted
        for word, count in counts.items()
        if count
    )
    if counted:
        columns = (Column("", Style.TEXT), Column("answer", Style.TEXT), Column("n"))
        blocks.append(Table("facts", "What they said of themselves", columns, counted, grouped=True))
    blocks.append(
        Text(
            "How to read: n counts who answered; blanks are left out, never taken for anything. SD is of the sample "
            "(n - 1). Intervals hold the true value with 95% confidence (means by Student's t, shares by Wilson). "
            "p is the share of all divisions into groups of these sizes that differ at least as much (exact "
            "permutation test, two-sided; in a large class a sample of 20,000 of them). Of twenty such p, one is below 0.05 by chance alone."
        )
    )
    return Chapter("class", "The class", tuple(blocks))


def _answered(setting: Setting, phase: Phase) -> int:
    """Students with at least one rating of that phase."""
    rows = [values for (of, _), values in setting.data.ratings.values.items() if of is phase]
    return int((~np.isnan(np.stack(rows))).any(axis=0).sum()) if rows else 0


def experience(setting: Setting) -> Chapter | None:
    """What they knew before, Algorithm 4, and the three divisions."""
    prior = setting.data.ratings.measures(Purpose.EXPERIENCE, Phase.BEFORE)
    if not prior:
        return None
    everybody = setting.data.ratings.overall(Purpose.EXPERIENCE, Phase.BEFORE)
    assert everybody is not None  # there are ratings
    blocks: list[Block] = [
        means_table(
            "prior", "Experience before, 1 to 7", (*prior, Measure("all", "All of it", everybody)), setting
        ),
        histogram("prior-histogram", "Students by mean experience before", everybody),
        *_scores(setting),
    ]
    return Chapter("experience", "Experience and expertise", tuple(blocks))


def _scores(setting: Setting) -> Iterator[Block]:
    if setting.score is None or not len(present(setting.score)):
        yield Caution("Nobody rated all six topics of Algorithm 4, so there are no scores and no groups.")
        return
    missing = int(np.isnan(setting.score).sum())
    if missing:
        yield Caution(
            f"{missing} of {len(setting.score)} left out a topic of Algorithm 4: no score, in no group."
        )
    names = {"ros": "the greater of ROS 1 and 2"}
    weights: tuple[tuple[Cell, ...], ...] = tuple(
        (names.get(topic, title_of(topic)), weight) for topic, weight in effective_weights()
    )
    yield Table(
        "weights",
        "What Algorithm 4 weighs in truth: its means of means come to this",
        (Column("rating", Style.TEXT), Column("weight", decimals=3)),
        weights,
    )
    order = np.argsort(-np.nan_to_num(setting.score, nan=-np.inf), kind="stable")[
        : len(setting.score) - missing
    ]
    rows: tuple[tuple[Cell, ...], ...] = tuple(
        (
            setting.data.names[i],
            float(setting.score[i]),
            *("expert" if each.experts.members[i] else "beginner" for each in setting.divisions),
        )
        for i in order
    )
    yield Table(
        "scores",
        "Expertise scores and divisions",
        (
            Column("student", Style.TEXT),
            Column("score"),
            *(Column(each.title, Style.TEXT) for each in setting.divisions),
        ),
        rows,
    )
    if not setting.divisions:
        yield Caution("The scores cannot be divided into two groups.")
        return
    yield _divisions(setting)
    for each in setting.divisions:
        yield from cautions_of(each)
    if setting.division is None:
        yield Caution(
            "The division asked for leaves one group empty, so the tables below do not divide the class."
        )
    else:
        yield Text(f"The tables below divide the class {setting.division.title}.")


def _divisions(setting: Setting) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for each in setting.divisions:
        assert setting.score is not None  # a division comes from scores
        parts: list[Cell] = [each.title]
        for group in each.groups:
            found = summary(setting.score[group.members])
            parts += [found.n, found.mean, found.sd]
        inside = setting.score[each.experts.members].min() - setting.score[each.beginners.members].max()
        rows.append((*parts, float(inside)))
    heads = ("n", "M", "SD")
    return Table(
        "divisions",
        "The groups by each division: beginners, then experts",
        (
            Column("", Style.TEXT),
            *(Column(f"{who} {head}") for who in ("B", "E") for head in heads),
            Column("gap"),
        ),
        tuple(rows),
        "gap: from the best beginner to the least expert.",
    )


def histogram(identity: str, title: str, values: np.ndarray[tuple[int], np.dtype[np.float64]]) -> Histogram:
    """Of ratings from 1 to 7."""
    counts, _ = np.histogram(present(values), BINS)
    return Histogram(identity, title, BINS, tuple(int(count) for count in counts))
