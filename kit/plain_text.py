"""Plain text for terminals, pipes and screen readers: quoting, suggestions of names, and tables of 80 columns."""

from __future__ import annotations

import math
import re
import textwrap
import unicodedata
from collections.abc import Collection, Iterable, Iterator, Sequence
from itertools import zip_longest
from typing import Final

WIDTH = 80
"""Characters in a line."""
MAX_PERCENT_DIGITS = 2
MAX_SHARE = 10.0
"""How many times of all a share is told exactly."""
MIN_COLUMN_WIDTH = 12
"""Table columns are not made narrower than this, even if the table exceeds its width."""
COLUMN_GAP = "  "
INDENT = "  "
_WORD = re.compile(
    r"-?\d[\d,]*(?:\.\d+)? (?:%|(?:m|cm|s|ms|rad|m/s|rad/s)(?![\w/]))[^\s`]*(?!\S)|(?:[^\s`]|`[^`\s](?:[^`\n]*[^`\s])?`)+(?!\S)|\S+"
)
"""A number with its unit, a word, or words between backticks with what touches them."""
_HELD = "\x1f"
"""In the place of a blank at which a line is not broken."""
_PARTS_END = "/,_"
"""Signs behind which a long word is broken."""
_PART = re.compile(rf"[^{_PARTS_END}]*[{_PARTS_END}]?")
_FORMULA: Final = ("=", "+", "-", "@", "\t", "\r", "|", "%", "\uff1d", "\uff0b", "\uff0d", "\uff20")
"""First characters by which a spreadsheet takes a text for a formula. The last four are the full-width forms, which it takes for
the plain ones in some languages."""
_NUMBER: Final = re.compile(r"[+-]?[0-9]+([.,][0-9]+)?")
MAX_KNOWN_NAMES = 12
"""Names that ``suggestion`` lists when none of them is close."""


# Quoting


def is_printable(text: str) -> bool:
    """Returns whether a terminal shows the text as it is: spaces of any language, but no control characters."""
    return text.isprintable() or all(c.isprintable() or unicodedata.category(c) == "Zs" for c in text)


def escape_controls(text: str) -> str:
    """Returns ``text`` with every control character but line breaks written out, as in Python: names of files that came
    from somebody else may hold anything.

    >>> escape_controls("a\\x1b[2Jb")
    'a\\\\x1b[2Jb'
    """
    return "".join(c if c == "\n" or is_printable(c) else ascii(c)[1:-1] for c in text)


def without_formula(cell: str) -> str:
    """Returns the text of a table's cell so that no spreadsheet takes it for a formula; a plain number, or a sign alone, stays.

    >>> without_formula("=1+1"), without_formula("-2.5")
    ("'=1+1", '-2.5')
    """
    is_formula = cell.startswith(_FORMULA) or cell.lstrip().startswith(_FORMULA)
    return f"'{cell}" if is_formula and len(cell) > 1 and not _NUMBER.fullmatch(cell) else cell


def format_clock(seconds: float, digits: int = 1) -> str:
    """Formats seconds as minutes and seconds, ``1:02.3``; cut, not rounded, as clocks do."""
    minutes, rest = divmod(math.floor(seconds * 10**digits + 1e-6), 60 * 10**digits)
    return f"{minutes}:{rest / 10**digits:0{3 + digits}.{digits}f}"


def format_size(size: float) -> str:
    """Formats a number of bytes in the unit that suits it, at most 10 characters up to 1 TiB: ``44.5 KiB``, ``12.0 B``."""
    for unit in ("B", "KiB", "MiB"):
        if size < 1023.95:
            return f"{size:.1f} {unit}"
        size /= 1024
    return f"{size:.1f} GiB"


def format_percent(share: float, *, beside: float = 1.0) -> str:
    """Formats a share in whole percents, with digits only where it would read as none, as all or as ``beside`` and is not; of
    one that is far above all, also without end, only that it is.

    >>> format_percent(1 / 3), format_percent(0.998), format_percent(0.899, beside=0.9)
    ('33 %', '99.8 %', '89.9 %')
    """
    if share > MAX_SHARE:
        return f"more than {MAX_SHARE * 100:.0f} %"
    others = {each for each in (0.0, 1.0, beside) if each != share}
    digits = next(
        (
            digits
            for digits in range(MAX_PERCENT_DIGITS)
            if not any(f"{share * 100:.{digits}f}" == f"{each * 100:.{digits}f}" for each in others)
        ),
        MAX_PERCENT_DIGITS,
    )
    return f"{share * 100:.{digits}f} %"


def counted(count: int, noun: str, plural: str = "") -> str:
    """A number with its noun, in the plural where it is not one: ``1 bump``, ``2 bumps``, ``0 entries``. ``plural``: of a noun
    that does not follow these rules."""
    if count == 1 or plural:
        return f"{count} {noun if count == 1 else plural}"
    return f"{count} {noun[:-1]}ies" if noun.endswith("y") and noun[-2] not in "aeiou" else f"{count} {noun}s"


def join_with_and(names: Iterable[object]) -> str:
    """a, b and c"""
    words = [str(name) for name in names]
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)


def quoted(text: str, limit: int = 60) -> str:
    """Returns ``text`` in double quotes for a message: cut to ``limit`` characters, control characters escaped."""
    shown = text if len(text) <= limit else text[: limit - 3] + "..."
    if not is_printable(shown):
        shown = "".join(c if is_printable(c) else ascii(c)[1:-1] for c in shown)
    return f'"{shown}"'


# Names


def holds_text(text: str, part: str) -> bool:
    """Whether a text holds a part, in any case; a number at its end must end there, too.

    >>> holds_text("It is 0.35.", "is 0.35"), holds_text("It is 0.35.", "is 0.3"), holds_text("It is 0.35.", "is 0.")
    (True, False, False)
    """
    return (
        re.search(re.escape(part) + (r"(?!\.?\d)" if part[-1:].isdigit() else r"(?!\d)"), text, re.IGNORECASE)
        is not None
    )


def nearest_name(name: str, names: Iterable[str]) -> str | None:
    """Returns the one of ``names`` closest to ``name``, ignoring case, or None if none is similar."""
    from difflib import get_close_matches  # in here: most processes never misspell anything

    by_lower = {known.lower(): known for known in names}
    close = get_close_matches(name.lower(), by_lower, n=1, cutoff=0.6)
    return by_lower[close[0]] if close else None


def suggestion(name: str, names: Collection[str]) -> str:
    """Returns the end of an error message about an unknown ``name``: the nearest of ``names``, or a list of them."""
    close = nearest_name(name, names)
    if close is not None:
        return f"did you mean {quoted(close)}?"
    if not names:
        return "there is none"
    known = [quoted(each) for each in sorted(names)]
    return "known: " + ", ".join(known[:MAX_KNOWN_NAMES]) + (", ..." if len(known) > MAX_KNOWN_NAMES else "")


def unknown_name(kind: str, name: str, names: Collection[str], lister: str = "") -> str:
    """Returns the error message about a ``name`` that nothing of a ``kind`` has: the nearest of ``names``, or else the command
    that lists them all, or a list of them.

    >>> unknown_name("level", "first-driv", ("first-drive", "slalom"))
    'There is no level "first-driv": did you mean "first-drive"?'
    >>> unknown_name("level", "x", ("first-drive", "slalom"), "kit game")
    'There is no level "x". `kit game` lists them.'
    """
    if lister and nearest_name(name, names) is None:
        return f"There is no {kind} {quoted(name)}. `{lister}` lists them."
    return f"There is no {kind} {quoted(name)}: {suggestion(name, names)}"


def join_names(names: Sequence[str], at_most: int = 4) -> str:
    """Returns the names separated by commas; of more than ``at_most`` the first ones and how many are left out."""
    if len(names) <= at_most:
        return ", ".join(names)
    return f"{', '.join(names[: at_most - 1])} and {len(names) - at_most + 1} more"


# Lines


def printable_line(text: str) -> str:
    """Removes control characters that a terminal would obey, and joins lines to one."""
    return "".join(c if is_printable(c) else " " if c.isspace() else "?" for c in text)


def wrap(text: str, width: int, first: str = "", rest: str = "", *, most: int | None = None) -> list[str]:
    """Wraps a text to lines of at most ``width`` characters, which begin with ``first`` and ``rest``; at least one line.

    It breaks at blanks alone, so that an option or a file name is never parted; not between a number and its unit; and between
    backticks only what is longer than a line; a word that is longer than a line is broken behind a slash, a comma or an underscore where it has one. A first word
    that fits on a later line alone begins there. Where there are more than ``most`` lines, the last one ends with dots.

    >>> wrap("see runs/turn-1/log.csv --set gamma", 12)
    ['see', 'runs/turn-1/', 'log.csv', '--set gamma']
    >>> wrap("it kept it for 70 % of its time", 17)
    ['it kept it for', '70 % of its time']
    """
    room, longest = max(width - len(first), 1), max(width - len(rest), 1)
    words = [
        part
        for word in _WORD.findall(text)
        for part in ([word.replace(" ", _HELD)] if len(word) <= longest else word.split())
    ]
    if words and room < len(words[0]) <= longest:  # it fits where a line is less indented
        below = None if most is None else max(most - 1, 1)
        return [first.rstrip(), *wrap(text, width, rest, rest, most=below)][:most]
    words = [
        part
        for number, word in enumerate(words)
        for part in _parts_of(word, longest if number else min(room, longest))
    ]
    lines = textwrap.wrap(
        " ".join(words),
        width,
        initial_indent=first,
        subsequent_indent=rest,
        break_on_hyphens=False,
        max_lines=most,
        placeholder=" ...",
    )
    return [line.replace(_HELD, " ") for line in lines] or [first.rstrip()]


def line_end(text: str, most: int, least: int = 0) -> int:
    """Returns how many of the first ``most`` characters stand on a first line of the text, which ends where ``wrap`` would end it,
    behind more than ``least``.

    >>> line_end("it kept it for 70 % of its time", 17), line_end("runs/turn-1/log.csv", 14)
    (14, 12)
    """
    for pattern in (_WORD, _PART):
        ends = [match.end() for match in pattern.finditer(text) if least < match.end() <= most]
        if ends:
            return ends[-1]
    return max(most, 1)


def longest_part(text: str) -> int:
    """Returns how many columns a text needs at least, so that no word of it is broken but behind a sign that ends a part."""
    return max((len(part) for word in text.split() for part in _PART.findall(word)), default=0)


def _parts_of(word: str, longest: int) -> Iterator[str]:
    while len(word) > longest:
        cut = max(word.rfind(sign, 1, longest) for sign in _PARTS_END) + 1 or longest
        yield word[:cut]
        word = word[cut:]
    yield word


def indent_lines(lines: Iterable[str]) -> list[str]:
    return [INDENT + line for line in lines]


def table(rows: Sequence[Sequence[str]], width: int = WIDTH) -> list[str]:
    """Returns the rows as aligned lines of at most ``width`` characters, wrapping the cells of the widest columns."""
    return [line for lines in _row_lines(rows, width) for line in lines]


def grouped_table(rows: Iterable[Sequence[str]], width: int = WIDTH) -> list[str]:
    """Like ``table``, but rows with the same first cell are indented below one line that holds that cell."""
    groups: dict[str, list[Sequence[str]]] = {}
    for first, *others in rows:
        groups.setdefault(first, []).append(others)
    lines = _row_lines([others for group in groups.values() for others in group], width - len(INDENT))
    text: list[str] = []
    for first, group in groups.items():
        text += wrap(first, width)
        text += indent_lines(line for _ in group for line in next(lines))
    return text


def _row_lines(rows: Sequence[Sequence[str]], width: int) -> Iterator[list[str]]:
    """Yields the lines of each row."""
    widths = fit_widths([max(1, *map(len, column)) for column in zip(*rows, strict=True)], width)
    for row in rows:
        cells = [wrap(cell, limit) for cell, limit in zip(row, widths, strict=True)]
        lines = zip_longest(*cells, fillvalue="")
        yield [COLUMN_GAP.join(map(str.ljust, line, widths)).rstrip() for line in lines]


def fit_widths(widths: Sequence[int], width: int, least: Sequence[int] | None = None) -> list[int]:
    """Returns the widths of a table's columns, the largest reduced until all fit into ``width`` side by side.

    ``least``: below which each is not reduced; by default ``MIN_COLUMN_WIDTH`` for all.
    """
    fitted = list(widths)
    bounds = [MIN_COLUMN_WIDTH] * len(fitted) if least is None else least
    over = sum(fitted) + len(COLUMN_GAP) * (len(fitted) - 1) - width
    while over > 0:
        candidates = [number for number, bound in enumerate(bounds) if fitted[number] > bound]
        if not candidates:
            break
        fitted[max(candidates, key=lambda number: fitted[number])] -= 1
        over -= 1
    return fitted
