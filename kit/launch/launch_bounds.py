"""Limits of what a launch starts."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

from kit.host.sandbox.limits import GIB, INTERACTIVE_LIMITS, MIB, Limits
from kit.host.sandbox.sandbox_config import INTERACTIVE_LEVEL, Level

PROGRAM_LIMITS: Final = replace(
    INTERACTIVE_LIMITS,
    start_s=120.0,
    reply_s=20.0,
    memory=32 * GIB,
    open_files=1024,
    file_size=4 * GIB,
    scratch=64 * GIB,
    files=1_000_000,
    output=MIB,
    frame=16 * MIB,
)
"""Limits of a package's program: generous, since it may import a learning library and train."""


@dataclass(frozen=True, slots=True)
class LaunchBounds:
    """Limits of what a launch starts. The defaults are for a user's own package."""

    level: Level = INTERACTIVE_LEVEL
    limits: Limits = PROGRAM_LIMITS
    file_limits: Limits | None = None
    """Limits of the launch file's own process; None: the usual ones, and the user's environment."""
    commands: bool = True
    """Whether other commands than programs of packages may be run."""
    max_processes: int | None = None
    """The number of processes that one launch may start; None: any."""

    @property
    def is_interactive(self) -> bool:
        """Whether what is launched is the user's own, and is run from the user's working directory."""
        return self.file_limits is None


INTERACTIVE_BOUNDS: Final = LaunchBounds()
