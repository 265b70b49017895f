"""The contract between the simulation and a plugin.

A plugin lives in one file of ``kit/sim/plugins/`` and never touches the graph: it *returns* messages and
*accepts* messages, and the runner of the simulation delivers them.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, NamedTuple


@dataclass(frozen=True, slots=True)
class TopicEndpoint:
    """A topic that a plugin publishes or subscribes, by its absolute name, and its message class."""

    direction: Literal["publish", "subscribe"]
    topic: str
    type: type[Any]
    is_ground_truth: bool = field(default=False, compare=False)
    """Whether its messages are the true state of the world, which no sensor could measure."""


class OutgoingMessage(NamedTuple):
    """A message that a plugin sends to a topic."""

    topic: str
    message: Any


class Plugin:
    """One plugin of one model (or of the world). The simulation calls it; these defaults do nothing."""

    endpoints: Sequence[TopicEndpoint] = ()

    def reset(self, seed: int) -> None:
        """Back to how it was when built, with noise that depends on ``seed`` alone."""

    def moved(self) -> None:
        """Called after a service has put its model elsewhere."""

    def accept(self, topic: str, message: Any) -> None:
        """Takes a message that arrived on one of its subscribed topics."""

    def before_step(self, dt: float) -> Iterable[OutgoingMessage]:
        """Called before the physics step: drives set velocities; lasers scan the world as it is now."""
        return ()

    def after_step(self, dt: float) -> Iterable[OutgoingMessage]:
        """Called after the physics step and the advance of the clock: bumpers report what touched."""
        return ()
