"""The slip in a text that is no YAML.

A parser reports where it gave up, which is often a line too late, in words about its own grammar. So common slips are
recognised here, with the line they are in and how to mend them.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Final, Protocol

from kit.plain_text import quoted

if TYPE_CHECKING:
    from yaml import MarkedYAMLError

MAX_SHOWN: Final = 60
"""Characters of a corrected line that are shown."""
_MISSING_BLANK: Final = re.compile(r"^\s*(?P<line>(?:- )*(?P<key>[A-Za-z_]\w*):(?P<value>(?!//)[^\s:].*))$")
_CLOSING: Final[Mapping[str, str]] = MappingProxyType({"[": "]", "{": "}"})


class ParserMark(Protocol):
    """A position in the text as the parser counts, from 0; its two implementations share no class."""

    @property
    def line(self) -> int: ...
    @property
    def column(self) -> int: ...


@dataclass(frozen=True, slots=True)
class YamlSlip:
    """A slip, with its 1-based line and column."""

    line: int
    column: int
    message: str


@dataclass(frozen=True, slots=True)
class ParserReport:
    """The parser's report on a text that it could not read."""

    lines: Sequence[str]
    context: str
    context_mark: ParserMark | None
    problem: str
    mark: ParserMark

    def line(self, index: int) -> str:
        """Returns a line by its 0-based index; empty where there is none."""
        return self.lines[index] if 0 <= index < len(self.lines) else ""

    def index_above(self) -> int:
        """Returns the index of the last line with content above the reported one; -1 if there is none."""
        above = range(min(self.mark.line, len(self.lines)) - 1, -1, -1)
        return next((index for index in above if self.lines[index].partition("#")[0].strip()), -1)


def parser_mistake(error: MarkedYAMLError, text: str) -> YamlSlip:
    """Where and why a parser gave up on a text: the slip that most likely made it do so, or else its own words."""
    mark = error.problem_mark or error.context_mark
    words = ", ".join(word for word in (error.context, error.problem) if word)
    if mark is None:
        return YamlSlip(1, 1, words)
    report = ParserReport(
        text.splitlines(), error.context or "", error.context_mark, error.problem or "", mark
    )
    return find_slip(report) or YamlSlip(mark.line + 1, mark.column + 1, words)


def find_slip(report: ParserReport) -> YamlSlip | None:
    """Returns the slip that most likely made the parser give up; None if it is none of the common ones."""
    return next(filter(None, (recognise(report) for recognise in _RECOGNISERS)), None)


def missing_blank(line: str) -> str | None:
    """Returns the cure for a line such as ``key:value``; None if that is not its mistake."""
    found = _MISSING_BLANK.match(line)
    if found is None:
        return None
    start = found["line"][: -len(found["value"])]
    cured = f"{start} {found['value'].strip()}"
    return f"a space is missing after the colon: write {quoted(cured, MAX_SHOWN)}"


def _tab(report: ParserReport) -> YamlSlip | None:
    line = report.line(report.mark.line)
    indentation = line[: len(line) - len(line.lstrip())]
    if "\t" not in indentation:
        return None
    message = "this line is indented with a tab: use spaces, as many as the neighbouring lines"
    return YamlSlip(report.mark.line + 1, indentation.index("\t") + 1, message)


def _open_bracket(report: ParserReport) -> YamlSlip | None:
    mark = report.context_mark
    if mark is None or not report.context.startswith("while parsing a flow"):
        return None
    rest = report.line(mark.line)[mark.column :]
    closing = _CLOSING.get(rest[:1], "")
    if not closing or closing in rest:
        return None
    return YamlSlip(
        mark.line + 1, mark.column + 1, f'this "{rest[0]}" is not closed: a "{closing}" is missing'
    )


def _open_quote(report: ParserReport) -> YamlSlip | None:
    mark = report.context_mark
    if mark is None or report.context != "while scanning a quoted scalar":
        return None
    message = "the quotation mark that opens here is not closed, at the latest at the end of its line"
    return YamlSlip(mark.line + 1, mark.column + 1, message)


def _missing_blank(report: ParserReport) -> YamlSlip | None:
    candidates = [report.mark.line, report.index_above()]
    if report.context_mark is not None and report.context == "while scanning a simple key":
        candidates.insert(0, report.context_mark.line)
    for index in candidates:
        cure = missing_blank(report.line(index))
        if cure is not None:
            return YamlSlip(index + 1, report.line(index).index(":") + 1, cure)
    return None


def _second_colon(report: ParserReport) -> YamlSlip | None:
    if not report.problem.startswith("mapping values are not allowed"):
        return None
    line, above = report.line(report.mark.line), report.line(report.index_above())
    at = report.mark.line + 1
    if ": " in line[: report.mark.column]:
        message = "a second colon in one line: put the text after the first one in quotation marks, or start a new line"
        return YamlSlip(at, report.mark.column + 1, message)
    if _indentation(line) > _indentation(above) and not above.rstrip().endswith(":"):
        message = (
            "this line is indented further than the one above, which already has a value: "
            "start both in the same column"
        )
        return YamlSlip(at, 1, message)
    return None


def _indentation_of_no_line(report: ParserReport) -> YamlSlip | None:
    line = report.line(report.mark.line)
    if report.problem.startswith(("did not find expected key", "expected <block end>")) and (
        0 < _indentation(line) == report.mark.column
    ):
        message = "this line starts in a different column from the lines it belongs to: indent it like them"
        return YamlSlip(report.mark.line + 1, report.mark.column + 1, message)
    return None


def _forbidden_start(report: ParserReport) -> YamlSlip | None:
    character = report.line(report.mark.line)[report.mark.column : report.mark.column + 1]
    if "cannot start any token" not in report.problem or character not in tuple("@`%"):
        return None
    message = f'"{character}" cannot start a value: put the value in quotation marks'
    return YamlSlip(report.mark.line + 1, report.mark.column + 1, message)


def _indentation(line: str) -> int:
    return len(line) - len(line.lstrip(" "))


_RECOGNISERS: Final[Iterable[Callable[[ParserReport], YamlSlip | None]]] = (
    _tab,
    _open_quote,
    _open_bracket,
    _missing_blank,
    _second_colon,
    _indentation_of_no_line,
    _forbidden_start,
)
"""From the surest to the vaguest."""
