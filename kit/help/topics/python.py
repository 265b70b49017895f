"""The public Python names, from their docstrings, whose examples a test runs."""

from __future__ import annotations

from typing import Final

import kit
from kit.document.blocks import Chapter
from kit.help.docstrings import docstring_blocks
from kit.help.topic import HelpTopic, Shelf, chapter


def _chapters() -> tuple[Chapter, ...]:
    return (
        chapter("For scripts and notebooks", *docstring_blocks(kit.__doc__ or "")),
        *(
            chapter(f"kit.{name}", *docstring_blocks(getattr(kit, name).__doc__ or ""))
            for name in kit.__all__
        ),
    )


TOPIC: Final = HelpTopic(
    "From Python", "the public names, with examples that run", Shelf.REFERENCE, _chapters
)
