"""The glossary: each term that the lessons use, in a sentence or two, and the lesson that introduces it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Final

from kit.dialogue.dialogue import DialogueAction, Refused
from kit.dialogue.effects import Effect, Tell
from kit.dialogue.shared_actions import ACTIONS
from kit.document.blocks import Block, Picture, Text, Tone
from kit.plain_text import quoted, unknown_name
from kit.school.lessons.reading import lesson_number, lessons_folder
from kit.world.documents import open_document
from kit.world.yaml_section import Section

GLOSSARY_FILE: Final = "glossary.yaml"


class UnknownTerm(LookupError):
    """The glossary has no such term; the message offers the nearest one."""


@dataclass(frozen=True, slots=True)
class GlossaryTerm:
    """A term and its meaning."""

    term: str
    also: tuple[str, ...]
    """Other spellings and words for the same."""
    lesson: str
    """The folder of the lesson that introduces it."""
    meaning: str
    picture: tuple[str, ...] = ()
    """Rows of ASCII characters; empty: no picture."""

    @property
    def spellings(self) -> tuple[str, ...]:
        return (self.term, *self.also)

    def matches(self, word: str) -> bool:
        """Whether ``word`` is one of its spellings, in the plural too; upper case does not matter."""
        known = {each.casefold() for each in self.spellings}
        word = " ".join(word.split()).casefold()
        return bool(known & {word, word.removesuffix("s"), word.removesuffix("es")})

    def blocks(self) -> tuple[Block, ...]:
        """The term with its lesson, and the meaning below, indented, with its picture where it has one."""
        named = " or ".join(self.spellings)
        tail = f"  (lesson {lesson_number(self.lesson)})"
        return (
            Text(named, Tone.BOLD, tail=tail),
            Text(self.meaning, indent=4, is_tight=True),
            *Picture.of_diagram(self.picture, 6),
        )


def read_glossary(folder: Path | None = None) -> tuple[GlossaryTerm, ...]:
    """Reads all terms, in alphabetical order. Raises WorldError with all mistakes, and FileNotFoundError.

    >>> any(each.matches("nodes") for each in read_glossary())
    True
    """
    with open_document((lessons_folder() if folder is None else folder) / GLOSSARY_FILE) as section:
        terms = tuple(_read_terms(section))
    return tuple(sorted(terms, key=lambda each: each.term.casefold()))


def find_terms(terms: Sequence[GlossaryTerm], word: str) -> tuple[GlossaryTerm, ...]:
    """Finds the terms that are spelt like ``word``; if there are none, those with a word that begins like it, in their names
    or else in their meanings. Raises UnknownTerm."""
    begins = re.compile(rf"\b{re.escape(word)}", re.IGNORECASE)
    found = (
        [each for each in terms if each.matches(word)]
        or [each for each in terms if any(map(begins.search, each.spellings))]
        or [each for each in terms if begins.search(each.meaning)]
    )
    if not found:
        spellings = [spelling for each in terms for spelling in each.spellings]
        raise UnknownTerm(unknown_name("term", word, spellings, "kit glossary"))
    return tuple(found)


def glossary_blocks(terms: Sequence[GlossaryTerm]) -> list[Block]:
    """The terms one below the other."""
    return [block for each in terms for block in each.blocks()]


@cache
def lesson_words(lesson: str) -> tuple[Block, ...]:
    """The terms that a lesson introduces, by its folder. Raises WorldError and FileNotFoundError."""
    return tuple(glossary_blocks([each for each in read_glossary() if each.lesson == lesson]))


def glossary_action() -> DialogueAction[Any]:
    """``,`` in a dialogue: the glossary, or with a word after it one term."""
    return DialogueAction(
        ACTIONS["glossary"], _show_glossary, takes_text=True, is_listed=False, while_busy=True
    )


def _show_glossary(dialogue: object, word: str = "") -> Effect:
    terms = read_glossary()
    try:
        return Tell("Glossary", glossary_blocks(find_terms(terms, word) if word else terms))
    except UnknownTerm as error:
        raise Refused(str(error)) from None


def _read_terms(section: Section) -> Iterator[GlossaryTerm]:
    seen: set[str] = set()
    for each in section.sections("terms", at_least=1):
        meaning = " ".join(each.text("means").split())
        picture = tuple(each.text("picture", "").rstrip().splitlines())
        term = GlossaryTerm(each.name("term"), each.texts("also", ()), each.name("lesson"), meaning, picture)
        for spelling in term.spellings:
            if spelling.casefold() in seen:
                each.error(f"{quoted(spelling)} is in the glossary already", "term")
            seen.add(spelling.casefold())
        each.finish()
        yield term
