"""What a reader takes a name for: letters of other alphabets that look like Latin ones, and signs that look alike.

The letters are those of Greek, Cyrillic and Armenian, and of extended Latin, that Unicode Technical Standard 39 lists as
confusable with a letter of ASCII (``confusables.txt``); other alphabets have more, which are not known here.
"""

from __future__ import annotations

import re
import unicodedata
from itertools import chain, count
from types import MappingProxyType
from typing import Final

_ALIKE: Final = (
    ("a", "аαɑΑА"),
    ("b", "ЬƄВΒ"),
    ("c", "сϲСϹ"),
    ("d", "ԁԀ"),
    ("e", "еЕΕє"),
    ("f", "ſϝ"),
    ("g", "ɡցԌ"),
    ("h", "һհНΗҺ"),
    ("i", "іιӏІΙӀıɩ1l|"),
    ("j", "јϳЈյ"),
    ("k", "кκКΚ"),
    ("m", "МΜмϺ"),
    ("n", "ոΝп"),
    ("o", "оοσОΟօՕ0"),
    ("p", "рρРΡ"),
    ("q", "ԛզԚ"),
    ("r", "гᴦ"),
    ("s", "ѕЅՏ"),
    ("t", "τтТΤ"),
    ("u", "υսՍ"),
    ("v", "νѵѴ"),
    ("w", "ԝωѡԜ"),
    ("x", "хχХΧ"),
    ("y", "уγУΥү"),
    ("z", "ΖᴢȤ"),
)
_LATIN_OF: Final = MappingProxyType({ord(sign): latin for latin, signs in _ALIKE for sign in signs})
INVISIBLE: Final = "\u034f\u115f\u1160\u17b4\u17b5\u180b-\u180f\u3164\uffa0\U000e0100-\U000e01ef"
"""Signs that show nothing, though Python counts them as printable: those of Unicode's Default_Ignorable_Code_Point
(``DerivedCoreProperties.txt``) but the variation selectors, as the inside of a class of a regular expression."""
_UNSEEN: Final = re.compile(f"[{INVISIBLE}\u2800\ufe00-\ufe0f]")
"""Those that change nothing in a name's look: also Braille's blank, and the variation selectors."""
_WORD: Final = re.compile(r"[^\W\d_]+")


def look(name: str) -> str:
    """Returns how a name is read: without double blanks, letters of other widths, and what cannot be seen."""
    shown = "".join(
        sign
        for sign in unicodedata.normalize("NFKC", _UNSEEN.sub("", name))
        if sign.isprintable() or sign.isspace()
    )
    return " ".join(shown.split()).casefold()


def outline(name: str) -> str:
    """Returns a text that is the same for all names that a reader can take for one another.

    It tells names apart, and is shown to nobody: who is meant by a name is what ``look`` says.
    """
    return look(look(name.translate(_LATIN_OF)).translate(_LATIN_OF))


def distinct_name(taken: set[str], name: str, file_name: str) -> str:
    """Returns a name, or its file's, if that looks like none of those whose ``outline`` is taken; else one with a number.
    Its own outline is taken then."""
    numbered = (f"{file_name} ({number})" for number in count(2))
    found = next(each for each in chain((name, file_name), numbered) if outline(each) not in taken)
    taken.add(outline(found))
    return found


def mark_foreign_letters(name: str) -> str:
    r"""Writes as ``\u0430`` each letter that looks like one of ASCII, where it stands in one word with letters of ASCII.

    Names that are all of one alphabet stay as they are.
    """
    return _WORD.sub(lambda found: _marked(found[0]), name)


def _marked(word: str) -> str:
    if word.isascii() or not any(sign.isascii() for sign in word):
        return word
    return "".join(
        f"\\u{ord(sign):04x}" if ord(sign) in _LATIN_OF and not sign.isascii() else sign for sign in word
    )
