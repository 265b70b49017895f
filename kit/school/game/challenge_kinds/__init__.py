"""The kinds of challenges: one file each, found by looking into this folder."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Mapping
from types import MappingProxyType

from kit.school.game.challenge import ChallengeTask

_KINDS: list[type[ChallengeTask]] = [
    importlib.import_module(f"{__name__}.{module.name}").KIND for module in pkgutil.iter_modules(__path__)
]

challenge_kinds: Mapping[str, type[ChallengeTask]] = MappingProxyType({each.kind: each for each in _KINDS})
"""Each kind by its name."""
