"""What a run learns and how: the contents of ``config.json``."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, Literal

from kit.field_types import MAX_WHOLE, check_field_types
from kit.learning.tasks.task_spec import TaskSpec

PresetName = Literal["kit", "seed", "seed-text"]
"""The kit's; the dissertation's as its code ran; the same as its text says (section 3.1.2)."""

MAX_WORLDS: Final = 100_000
"""Worlds that are simulated at once: their memory grows with them, and a run may be somebody else's."""


NO_LIMIT = "none"
"""Stands for an infinite limit."""


def format_settings(settings: Iterable[tuple[str, float]]) -> str:
    """Changed settings, as ``--set`` takes them: ``gamma=0.98 n_steps=64``."""
    return " ".join(f"{name}={format_setting(number)}" for name, number in settings)


def format_setting(number: float) -> str:
    """A setting's number, as ``--set`` takes it: infinity, of a limit, is ``none``."""
    return NO_LIMIT if math.isinf(number) else f"{number:.12g}"


class RunError(Exception):
    """A run is missing, damaged or busy, or cannot be written; the message says what to do."""


@dataclass(frozen=True, slots=True)
class RunConfig:
    """The task of a run and how it is learned."""

    choice: TaskSpec
    algorithm: str = "ppo"
    preset: PresetName = "kit"
    seed: int = 0
    steps: int | None = None
    """Instead of the preset's."""
    worlds: int | None = None
    learning_rate: float | None = None
    """Constant, instead of the preset's."""
    goal: float | None = None
    """Instead of the strategy's."""
    keep_training: bool = False
    """Use the dissertation's first strategy: to the last step, whatever tests say."""
    reward_file: str | None = None
    """A student's reward, instead of the task's."""
    mirrored: bool = False
    """Half of the worlds are seen in a mirror: what is learned on one side is known on the other."""
    imitate: tuple[str, ...] = ()
    """Files of demonstrators: recordings, policies, controllers."""
    settings: tuple[tuple[str, float], ...] = ()
    """Names and numbers of settings, instead of the preset's; see ``kit.learning.training.presets``."""

    @property
    def preset_text(self) -> str:
        """The preset and the settings that differ from it: ``preset kit, gamma=0.98``."""
        return f"preset {self.preset}" + (f", {format_settings(self.settings)}" if self.settings else "")

    @property
    def reward_name(self) -> str:
        """The reward that is not the task's own: a file's name, or the name of one of the kit's; else empty."""
        return Path(self.reward_file).name if self.reward_file is not None else self.choice.reward or ""

    def as_dict(self) -> dict[str, Any]:
        """JSON-able."""
        values = {name: getattr(self, name) for name in self.__dataclass_fields__ if name != "choice"}
        # JSON has no infinity.
        settings = {name: NO_LIMIT if math.isinf(number) else number for name, number in self.settings}
        return {"choice": self.choice.as_dict(), **values, "settings": settings}

    @classmethod
    def from_dict(cls, data: Any) -> RunConfig:
        """Reads what ``as_dict`` returned. Raises ValueError for anything else."""
        try:
            plain = {name: value for name, value in data.items() if name not in ("choice", "settings")}
            settings = tuple(
                (str(name), math.inf if number == NO_LIMIT else number)
                for name, number in data["settings"].items()
            )
            check_field_types(cls, plain)
            if not all(type(number) in (int, float) for _, number in settings):
                raise ValueError("settings are numbers")
            choice = TaskSpec.from_dict(data["choice"])
            config = cls(choice, **{**plain, "imitate": tuple(data["imitate"])}, settings=settings)
        except (TypeError, KeyError, AttributeError) as error:
            raise ValueError(f"not the configuration of a run: {error}") from None
        counts = (config.steps, config.worlds)
        if not 0 <= config.seed <= MAX_WHOLE or any(
            each is not None and not 1 <= each <= MAX_WHOLE for each in counts
        ):
            raise ValueError("a seed, steps or worlds that are too many, or none")
        if not all(each is None or 0.0 <= each < math.inf for each in (config.goal, config.learning_rate)):
            raise ValueError(f"goal {config.goal}, learning rate {config.learning_rate}")
        if (config.worlds or 1) > MAX_WORLDS:
            raise ValueError(f"{config.worlds} worlds; at most {MAX_WORLDS:,} are simulated at once")
        return config
