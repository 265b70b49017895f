"""The options for the quality of service of ``topic echo``, ``hz``, ``bw``, ``delay`` and ``pub``."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import wraps
from typing import Any

import click

from kit.ros.node.qos import DurabilityPolicy, HistoryPolicy, QoSPresetProfiles, QoSProfile, ReliabilityPolicy


@dataclass(frozen=True, slots=True)
class QosOptions:
    """The values of the options; None where one was not given."""

    preset: str | None
    history: str | None
    depth: int | None
    reliability: str | None
    durability: str | None

    def profile(self, default: QoSProfile) -> QoSProfile:
        """The profile: the preset, or ``default`` without one, changed by the other options."""
        base = default if self.preset is None else QoSPresetProfiles.get_from_short_key(self.preset)
        profile = QoSProfile(
            history=base.history, depth=base.depth, reliability=base.reliability, durability=base.durability
        )
        if self.depth is not None:
            profile.history, profile.depth = HistoryPolicy.KEEP_LAST, self.depth
        if self.history is not None:
            profile.history = HistoryPolicy.get_from_short_key(self.history)
        if self.reliability is not None:
            profile.reliability = ReliabilityPolicy.get_from_short_key(self.reliability)
        if self.durability is not None:
            profile.durability = DurabilityPolicy.get_from_short_key(self.durability)
        return profile


def with_qos_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """Decorator: adds the options, and passes their values as ``qos_options``."""

    @click.option("--qos-profile", type=click.Choice(QoSPresetProfiles.short_keys()), help="A preset.")
    @click.option("--qos-history", type=click.Choice(HistoryPolicy.short_keys()))
    @click.option("--qos-depth", type=click.IntRange(0))
    @click.option("--qos-reliability", type=click.Choice(ReliabilityPolicy.short_keys()))
    @click.option("--qos-durability", type=click.Choice(DurabilityPolicy.short_keys()))
    @wraps(function)
    def verb(
        *arguments: Any,
        qos_profile: str | None,
        qos_history: str | None,
        qos_depth: int | None,
        qos_reliability: str | None,
        qos_durability: str | None,
        **rest: Any,
    ) -> None:
        qos_options = QosOptions(qos_profile, qos_history, qos_depth, qos_reliability, qos_durability)
        function(*arguments, qos_options=qos_options, **rest)

    return verb
