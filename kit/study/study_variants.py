"""Whose settings a training of the study has: the dissertation's, the same without its limit of values, or the kit's."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, Literal

StudyVariant = Literal["seed", "no-limit", "kit"]
"""The settings that agents are trained by: the dissertation's, the same without the limit of values, or the kit's own presets."""
VARIANTS: Final[tuple[StudyVariant, ...]] = ("seed", "no-limit", "kit")
CONTROLLERS: Final[Mapping[StudyVariant, str]] = {"seed": "fields", "kit": "abreast"}
"""The controller that stands for the dissertation's potential fields: its own, or the kit's planner."""
VARIANT_NAMES: Final[Mapping[StudyVariant, str]] = {
    "seed": "ours",
    "no-limit": "no limit",
    "kit": "kit",
}
"""The words of a table's rows: agents trained by the dissertation's settings, and by the kit's."""
VARIANT_OPTIONS: Final[Mapping[StudyVariant, str]] = {"seed": "", "no-limit": " --no-limit", "kit": " --kit"}
"""What follows ``kit study NUMBER --again``."""
