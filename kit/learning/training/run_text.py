"""Formats what happens in runs as text: one line for an event, a table for several policies."""

from __future__ import annotations

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
        f"({case}){kept}{reason}"
    )


def success_shares(event: Evaluated) -> dict[str, float]:
    """By case: how many of the episodes reached the target."""
    return {name: counts[0] / max(1, sum(counts)) for name, counts in event.cases.items()}


def format_comparison(results: dict[str, EvaluationResult]) -> list[str]:
    """A row for each case, a column for each policy."""
    cases = list(dict.fromkeys(case.case for result in results.values() for case in result.cases))
    width = max(len("worst"), *(len(case) for case in cases))
    columns = [max(7, len(name)) for name in results]
    rows = ["  ".join([f"{'case':{width}}", *(f"{n:>{w}}" for n, w in zip(results, columns, strict=True))])]
    shares = [{case.case: case.share for case in result.cases} for result in results.values()]
    for case in cases:
        found = [
            f"{share[case]:>{w}.3f}" if case in share else " " * w
            for share, w in zip(shares, columns, strict=True)
        ]
        rows.append("  ".join([f"{case:{width}}", *found]))
    ends = {
        "mean": [each.mean for each in results.values()],
        "worst": [each.worst.share for each in results.values()],
    }
    for name, values in ends.items():
        found = [f"{value:>{w}.3f}" for value, w in zip(values, columns, strict=True)]
        rows.append("  ".join([f"{name:{width}}", *found]))
    return rows
