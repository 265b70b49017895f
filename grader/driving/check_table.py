"""All checks of controllers, by name."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from grader.check import Check
from grader.driving.checks.interfaces import answered, hears, named, obeys, profiles, rate, says, topics
from grader.driving.checks.speeds import (
    flag_by_range,
    keeps_speed,
    smooth,
    speed_by_flag,
    speed_by_range,
    top_speed,
)
from grader.driving.checks.walls import bumps, clearance, goes_home, keeps_distance
from grader.driving.checks.ways import (
    approach,
    circle,
    comes_back,
    comes_by,
    faces,
    gets_about,
    in_time,
    moves,
    reached,
    remaining_turn,
    runs,
    short_way,
)

CHECKS: Final[Mapping[str, Check]] = MappingProxyType(
    {
        each.name: each
        for each in (
            runs,
            reached,
            in_time,
            approach,
            bumps,
            clearance,
            keeps_distance,
            smooth,
            moves,
            gets_about,
            top_speed,
            short_way,
            rate,
            topics,
            obeys,
            circle,
            named,
            hears,
            profiles,
            comes_by,
            comes_back,
            faces,
            remaining_turn,
            speed_by_range,
            flag_by_range,
            speed_by_flag,
            says,
            keeps_speed,
            answered,
            goes_home,
        )
    }
)
"""Every check of a drive, by name."""
