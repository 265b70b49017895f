"""The options that set a quality of service, for the verbs that listen and publish."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import wraps
from typing import Any

import click

from kit.ros.node.qos import DurabilityPolicy, HistoryPolicy, QoSPresetProfiles, QoSProfile, ReliabilityPolicy


@dataclass(frozen=True, slots=True)
class Wishes:
    """What was asked for; None where nothing was."""

    profile: str | None
    history: str | None
    depth: int | None
    reliability: str | None
    durability: str | None

    def on(self, usual: QoSProfile) -> QoSProfile:
        """``usual``, or the preset asked for, with what else was asked for."""
        base = usual if self.profile is None else QoSPresetProfiles.get_from_short_key(self.profile)
        made = QoSProfile(
            history=base.history, depth=base.depth, reliability=base.reliability, durability=base.durability
        )
        if self.depth is not None:
            made.history, made.depth = HistoryPolicy.KEEP_LAST, self.depth
        if self.history is not None:
            made.history = HistoryPolicy.get_from_short_key(self.history)
        if self.reliability is not None:
            made.reliability = ReliabilityPolicy.get_from_short_key(self.reliability)
        if self.durability is not None:
            made.durability = DurabilityPolicy.get_from_short_key(self.durability)
        return made


def quality_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """Adds the options; the function gets ``wishes``."""

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
        wishes = Wishes(qos_profile, qos_history, qos_depth, qos_reliability, qos_durability)
        function(*arguments, wishes=wishes, **rest)

    return verb
