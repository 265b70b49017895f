"""How a training run stands, from its events: state, steps, last and best test."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any, Literal

from kit.learning.training.events import (
    Evaluated,
    TrainingEnded,
    TrainingEvent,
    TrainingProgress,
    TrainingStarted,
)

TrainingCommand = Literal["go", "pause", "stop"]
"""Commands that a user interface may send to a learner."""


RunState = Literal["running", "paused", "finished", "stopped", "failed", "interrupted", "new"]


@dataclass(frozen=True, slots=True)
class TrainingSummary:
    """The state of a run and its last results."""

    state: RunState
    steps: int = 0
    seconds: float = 0.0
    rate: float = 0.0
    last_evaluation: Evaluated | None = None
    """The last test."""
    best_evaluation: Evaluated | None = None
    """That of the best policy."""
    reason: str = ""
    measures: dict[str, float] = field(default_factory=dict)
    """What the learner last measured of its own learning; see ``kit.learning.training.measures``."""

    def as_dict(self) -> dict[str, Any]:
        """JSON-able."""
        return asdict(self)


def summarise_events(
    events: tuple[TrainingEvent, ...], *, alive: bool, order: TrainingCommand
) -> TrainingSummary:
    """Summarises a run's events."""
    steps, seconds, rate, reason = 0, 0.0, 0.0, ""
    tested: Evaluated | None = None
    best: Evaluated | None = None
    measures: dict[str, float] = {}
    state: RunState = "interrupted" if events else "new"
    for event in events:
        match event:
            case TrainingStarted():
                state, steps = "interrupted", event.steps
            case TrainingProgress():
                steps, seconds, rate = event.steps, event.seconds, event.rate
                measures = event.measures or measures
            case Evaluated():
                tested, measures = event, event.measures or measures
                best = event if event.kept else best
            case TrainingEnded():
                state, steps, seconds, reason = event.how, event.steps, event.seconds, event.reason
            case _:
                pass
    if alive:
        state = "paused" if order == "pause" else "running"
    return TrainingSummary(state, steps, seconds, rate, tested, best, reason, measures)
