"""What is new on a screen since the last update: one line, told at the first visit and never again.

The journal keeps which lines were told, so that neither another machine nor a restart tells one twice.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from types import MappingProxyType
from typing import Final

from kit.school.progress import EventKind, ProgressError, ProgressJournal

NEWS: Final[Mapping[str, tuple[str, str]]] = MappingProxyType(
    {
        "start": ("0.2.0", "W, A, S and D drive. 4: a game about a hospital's new robot wheelchair."),
        "levels": (
            "0.2.0",
            "d is today's maze, the same for all; 2 plays tag or a race.",
        ),
        "lessons": ("0.2.0", "^E edits your program."),
    }
)
"""Of each screen, by the name of its actions, the version that brought something and a line about it."""
SINCE: Final = "version"


def take_news(journal: ProgressJournal, screen: str) -> str:
    """The line about what is new on a screen, the first time that it is asked for; then it is empty. Also where the journal
    cannot keep that it was told."""
    version, line = NEWS[screen]
    with suppress(ProgressError):
        told = journal.events(EventKind.NEWS, screen)
        if version not in {event.text(SINCE) for event in told}:
            journal.add(EventKind.NEWS, screen, {SINCE: version})
            return f"New: {line}"
    return ""
