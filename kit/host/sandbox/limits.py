"""How much a student's code may take. Times are wall seconds unless they say CPU."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

KIB: Final = 1024
MIB: Final = 1024 * KIB
GIB: Final = 1024 * MIB


@dataclass(frozen=True, slots=True)
class Limits:
    """What the launcher enforces on one child. The defaults suit a desk: generous, there to stop accidents."""

    start_s: float = 20.0
    """Until the code is loaded and waits for the first time. Importing large packages happens here."""
    reply_s: float = 3.0
    """Until each complete reply."""
    total_s: float | None = None
    """Of all waiting for replies together; None is no end."""
    cpu_s: int | None = None
    """CPU seconds of the child in all, counted by the kernel; None is no end."""
    memory: int = 8 * GIB
    """Bytes of address space."""
    open_files: int = 256
    processes: int | None = None
    """Processes and threads beyond what the user has already; None is no limit. Root is never limited."""
    file_size: int = 256 * MIB
    """Bytes of one written file."""
    scratch: int = 256 * MIB
    """Bytes of all files that it writes together. From confinement level 2 on: below, nothing counts them."""
    output: int = 64 * KIB
    """Bytes of printed text kept until somebody takes them; more is counted and dropped."""
    frame: int = 4 * MIB
    """Bytes of one frame from the child."""


INTERACTIVE_LIMITS: Final = Limits()
"""At the desk and in the terminal game: the student's own machine."""

GRADER_LIMITS: Final = Limits(
    start_s=15.0,
    reply_s=5.0,
    total_s=120.0,
    cpu_s=60,
    memory=1 * GIB,
    open_files=64,
    processes=16,
    file_size=8 * MIB,
    scratch=32 * MIB,
    output=32 * KIB,
    frame=1 * MIB,
)
"""In the grader: a long reply is tolerated now and then (a busy machine), not for ever."""
