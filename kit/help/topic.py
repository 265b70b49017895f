"""A topic of the help and how it is found: a module of ``kit/help/topics/`` with a record ``TOPIC``."""

from __future__ import annotations

import pkgutil
import re
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from importlib import import_module
from typing import Final

from kit.document.blocks import Block, Chapter, Document, Marked
from kit.help import topics


class Shelf(StrEnum):
    """What kind of page it is, in the order of the list of topics."""

    HOW_TO = "How to do it"
    REFERENCE = "To look up"
    BACKGROUND = "Why it is so"


@dataclass(frozen=True, slots=True)
class HelpTopic:
    """One page."""

    title: str
    summary: str
    """Its line in the list of topics."""
    shelf: Shelf
    chapters: Callable[[], tuple[Chapter, ...]]
    """Writes the page, which may import and measure what it is about."""

    def document(self) -> Document:
        """The whole page."""
        return Document(self.title, self.chapters())


def chapter(title: str, *parts: Block | str) -> Chapter:
    """A chapter whose texts are marked up; its id is made of its title.

    >>> chapter("Your first day", "Type `kit`.").id
    'your-first-day'
    """
    blocks = tuple(Marked(part.strip("\n")) if isinstance(part, str) else part for part in parts)
    return Chapter(re.sub(r"\W+", "-", title.lower()).strip("-"), title, blocks)


_MODULES: Final = {each.name.replace("_", "-"): each.name for each in pkgutil.iter_modules(topics.__path__)}


def topic_names() -> tuple[str, ...]:
    """The names of all topics, sorted; imports none."""
    return tuple(sorted(_MODULES))


def find_topic(name: str) -> HelpTopic:
    """The topic of a name that ``topic_names`` lists; its module is imported now. KeyError if there is none."""
    found: HelpTopic = import_module(f"{topics.__name__}.{_MODULES[name]}").TOPIC
    return found
