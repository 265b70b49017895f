"""Formats what happens in runs as text: one line for an event, tables that compare policies."""

from __future__ import annotations

from collections.abc import Mapping

from kit.document.blocks import Cell, CellStyle, Column, Table
from kit.learning.environment.episode_stats import EpisodeOutcome
from kit.learning.policies.evaluation import EvaluationResult
from kit.learning.training.events import (
    Evaluated,
    TrainingEnded,
    TrainingEvent,
    TrainingNote,
    TrainingProgress,
    TrainingStarted,
)
from kit.learning.training.measures import VALUE_PAYABLE, format_measures


def format_event(event: TrainingEvent) -> str:
    """Formats an event as one line."""
    match event:
        case TrainingStarted():
            return f"started at step {event.steps:,}" if event.steps else "started"
        case TrainingProgress():
            return _format_progress(event)
        case Evaluated():
            return _format_evaluation(event)
        case TrainingNote():
            return event.text
        case TrainingEnded():
            return f"{event.how} after {event.steps:,} steps and {event.seconds:.1f} s: {event.reason}"


def _format_progress(event: TrainingProgress) -> str:
    ends = [sum(counts[place] for counts in event.episodes.values()) for place in range(len(EpisodeOutcome))]
    total = sum(ends)
    parts = [f"{event.steps:>11,} steps  {event.seconds:7.1f} s  {event.rate:8,.0f} steps/s"]
    if total:
        parts.append(
            ", ".join(
                f"{end / total:.0%} {kind.value}" for end, kind in zip(ends, EpisodeOutcome, strict=True)
            )
        )
    if event.reward is not None:
        parts.append(f"reward {event.reward:.2f}")
    return "  ".join(parts)


def _format_evaluation(event: Evaluated) -> str:
    shares = success_shares(event)
    case = min(shares, key=lambda name: shares[name])
    mean = sum(shares.values()) / len(shares)
    kept = ", kept" if event.kept else ""
    reason = f"; {event.reason}" if event.reason else ""
    return (
        f"{event.steps:>11,} steps  {event.seconds:7.1f} s  TEST mean {mean:.3f}, worst {shares[case]:.3f} "
        f"({case}){kept}{_measures_told(event.measures)}{reason}"
    )


def _measures_told(measures: Mapping[str, float]) -> str:
    """The measures, but for what rewards can pay."""
    shown = {name: number for name, number in measures.items() if name != VALUE_PAYABLE}
    return f"; {format_measures(shown)}" if shown else ""


def success_shares(event: Evaluated) -> dict[str, float]:
    """Returns the share of episodes that reached the target, by case."""
    return {name: counts[0] / max(1, sum(counts)) for name, counts in event.cases.items()}


def comparison_tables(results: Mapping[str, EvaluationResult]) -> list[Table]:
    """A row for each case, a column for each policy: success, and a second table of the adjacency of those that drive two robots."""
    shares = {name: {case.case: case.share for case in each.cases} for name, each in results.items()}
    pairs = {
        name: {case.case: case.adjacency for case in each.cases}
        for name, each in results.items()
        if each.is_pair
    }
    own = dict.fromkeys(name for result in results.values() for name in result.metrics)
    tables = [_comparison_table("case", shares, with_worst=True)]
    for metric in own:
        values = {
            name: {case.case: case.metrics[metric] for case in each.cases}
            for name, each in results.items()
            if metric in each.metrics
        }
        tables.append(_comparison_table(metric, values, with_worst=False))
    return [*tables, _comparison_table("adj rays", pairs, with_worst=False)] if pairs else tables


def _comparison_table(title: str, columns: Mapping[str, Mapping[str, float]], *, with_worst: bool) -> Table:
    """``columns``: by policy, its value in each case."""
    cases = dict.fromkeys(case for values in columns.values() for case in values)
    rows: list[tuple[Cell, ...]] = [
        (case, *(each.get(case, "") for each in columns.values())) for case in cases
    ]
    rows.append(("mean", *(sum(each.values()) / len(each) for each in columns.values())))
    if with_worst:
        rows.append(("worst", *(min(each.values()) for each in columns.values())))
    heads = (Column(title, CellStyle.TEXT), *(Column(name, decimals=3) for name in columns))
    return Table("comparison", "", heads, tuple(rows), is_ruled=False)
