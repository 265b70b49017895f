"""The reference of ``assignment.yaml``: every key that its reader asks for, with type, default, meaning and an example.

Types, bounds and defaults are not written here: they are noted while the reader reads the examples of a kind. So the
reference cannot say anything else than the reader does.
"""

from __future__ import annotations

import ast
import inspect
import re
import textwrap
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from itertools import zip_longest
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

from grader.new_assignment import example_of_kind
from grader.reading import ASSIGNMENT_FILE, BUDGET_KEYS, SECRET_FILE, budget_lines, read_sheet
from kit.world.documents import AllowedRoot, WorldDocuments, open_document
from kit.world.problems import ProblemCollector, WorldError
from kit.world.records import SourceLocation
from kit.world.yaml_section import REQUIRED, Section

MEANINGS_FILE: Final = Path(__file__).parent / "sheet_keys.yaml"


@dataclass(frozen=True, slots=True)
class SheetKey:
    """One key of a sheet."""

    path: str
    """Where it stands: ``checks.points``; entries of a list are not counted."""
    type: str
    default: str
    """Empty where the key must be given; ``none`` where leaving it out is a meaning of its own."""
    meaning: str
    example: str
    """As it stands in an example of the kind; may be empty."""


TYPES: Final[Mapping[str, str]] = MappingProxyType(
    {
        "text": "text",
        "name": "one line of text",
        "choice": "text",
        "number": "number",
        "integer": "whole number",
        "integers": "list of whole numbers",
        "flag": "true or false",
        "numbers": "list of numbers",
        "points": "list of points [x, y]",
        "poses": "list of poses [x, y, theta]",
        "texts": "list of texts",
        "names": "text, or list of texts",
        "color": "[red, green, blue, alpha]",
        "point": "[x, y]",
        "pose": "[x, y, theta]",
        "section": "mapping",
        "sections": "list of mappings",
        "keys": "mapping with names of your own",
    }
)
"""What a key holds, by the getter of ``Section`` that reads it."""


NAMED_BY_TEACHER: Final = ("questions", "answers", "feedback", "secret.seeds", "arguments", "request")
"""Mappings whose keys are the teacher's own names; each stands for all, as ``NAME``."""


class RecordingSection(Section):
    """A section that notes each key that its reader asks for, as it is asked for: type, bounds and default."""

    path: str
    asked: dict[str, SheetKey]
    pretends: Callable[[str], bool]
    """Whether it behaves as if it held the key of this path, so that the reader asks what stands there."""

    @classmethod
    def of(
        cls, section: Section, path: str, asked: dict[str, SheetKey], *, pretends: Callable[[str], bool]
    ) -> RecordingSection:
        """Returns the same section, noting its keys in ``asked`` below ``path``."""
        made = cls.__new__(cls)
        made.__dict__.update(section.__dict__)
        made.path, made.asked, made.pretends = path, asked, pretends
        return made

    def path_of(self, key: str) -> str:
        """Returns where the key stands, without names that are the teacher's own."""
        return f"{self.path}.{'NAME' if self.path.endswith(NAMED_BY_TEACHER) else key}".lstrip(".")

    def note(self, getter: str, key: str, default: object, bounds: Mapping[str, Any]) -> None:
        """Notes a key that is asked for."""
        path = self.path_of(key)
        known = self.asked.get(path)
        if known is None or known.type == "":
            shown = _default_text(default, is_optional=known is not None)
            self.asked[path] = SheetKey(
                path, TYPES[getter] + _bounds_text(bounds), shown, "", self._written(key)
            )

    def has(self, key: str) -> bool:
        path = self.path_of(key)
        self.asked.setdefault(path, SheetKey(path, "", "none", "", ""))
        return super().has(key) or self.pretends(path)

    def below(self, got: Section, key: str) -> RecordingSection:
        """Returns a section of this one, which notes its keys too."""
        return RecordingSection.of(got, self.path_of(key), self.asked, pretends=self.pretends)

    def absent(self, key: str) -> RecordingSection:
        """Returns an empty section in place of one that is not written, so that the reader asks for its keys."""
        return self.below(self._missing_section(self.location), key)

    def _written(self, key: str) -> str:
        entry = self._entries.get(key)
        text = "" if entry is None else getattr(entry.value, "text", "")
        return " ".join(text.split()) if len(text) <= 40 else ""


def _wrap(name: str) -> None:
    """Makes the recording twin of a getter."""
    getter = getattr(Section, name)
    parameters = inspect.signature(getter).parameters

    def recorded(self: RecordingSection, key: str, *args: Any, **keywords: Any) -> Any:
        given = dict(zip([each for each in parameters if each not in ("self", "key")], args, strict=False))
        bounds = {**given, **keywords}
        default = bounds.pop(
            "default", parameters["default"].default if "default" in parameters else REQUIRED
        )
        options = bounds.pop("options", None)
        if options is not None:
            bounds["choices"] = tuple(options)
        self.note(name, key, default, bounds)
        got = getter(self, key, *args, **keywords)
        if name == "section":
            if got is None:
                return self.absent(key) if self.pretends(self.path_of(key)) else None
            return self.below(got, key)
        if name == "sections":
            if not got and self.pretends(self.path_of(key)):
                return (self.absent(key),)
            return tuple(self.below(each, key) for each in got)
        return got

    setattr(RecordingSection, name, recorded)


for _name in TYPES:
    if _name != "keys":
        _wrap(_name)


def _default_text(default: object, *, is_optional: bool) -> str:
    if default is REQUIRED:
        return "none" if is_optional else ""
    if default is None or default in ((), ""):
        return "none"
    if isinstance(default, bool):
        return str(default).lower()
    if isinstance(default, (tuple, list)):
        return f"[{', '.join(_default_text(each, is_optional=False) for each in default)}]"
    return f"{default:g}" if isinstance(default, float) else str(default)


def _bounds_text(bounds: Mapping[str, Any]) -> str:
    parts = []
    if (choices := bounds.get("choices")) is not None:
        return f": {', '.join(choices)}" if 1 < len(choices) <= 8 else ""
    if bounds.get("minimum") is not None:
        parts.append(f"from {bounds['minimum']:,.10g}")
    if bounds.get("above") is not None:
        parts.append(f"above {bounds['above']:,.10g}")
    if bounds.get("maximum") is not None and bounds["maximum"] < 1e12:
        parts.append(f"to {bounds['maximum']:,.10g}")
    if bounds.get("at_least"):
        parts.append(f"at least {bounds['at_least']}")
    return f" {' '.join(parts)}" if parts else ""


def recorded_keys(folder: Path) -> Mapping[str, SheetKey]:
    """Returns the keys that the reader asks for in the assignment of this folder, by path; ``secret.KEY`` are those of the
    secret file. Raises WorldError if it cannot be read."""
    asked: dict[str, SheetKey] = {}
    _read_recorded(folder, asked, pretends=lambda path: False)
    # What the reader would ask for if more keys were there: all, then those alone of which nothing else is known. That the
    # example has not got them is no mistake of its own.
    with suppress(WorldError, LookupError):
        _read_recorded(folder, asked, pretends=lambda path: True)
    for missing in [path for path, key in asked.items() if not key.type]:
        with suppress(WorldError, LookupError):
            _read_recorded(folder, asked, pretends=missing.__eq__)
    return asked


def _read_recorded(folder: Path, asked: dict[str, SheetKey], *, pretends: Callable[[str], bool]) -> None:
    documents = WorldDocuments(AllowedRoot.of_folder(folder), {}, ProblemCollector())
    secret_file = folder / SECRET_FILE
    secret = documents.section(secret_file, SourceLocation(secret_file)) if secret_file.is_file() else None
    hidden = None if secret is None else RecordingSection.of(secret, "secret", asked, pretends=pretends)
    with documents.open(folder / ASSIGNMENT_FILE) as section:
        recording = RecordingSection.of(section, "", asked, pretends=pretends)
        read_sheet(recording, hidden, folder, documents.problems)


@cache
def meanings() -> Mapping[str, Mapping[str, str]]:
    """Returns what keys mean: for ``all`` kinds, and for each kind those of its own."""
    with open_document(MEANINGS_FILE) as section:
        groups = [(name, section.section(name)) for name in section.keys()]  # noqa: SIM118  # a section is no mapping
        return {name: {key: part.text(key) for key in part.keys()} for name, part in groups}  # noqa: SIM118


def sheet_keys(kind: str) -> tuple[SheetKey, ...]:
    """Returns the keys of a kind's sheets, in the order of their meanings: those of all kinds, then its own.

    Raises WorldError, FileNotFoundError if the lessons are not installed.
    """
    asked = recorded_keys(example_of_kind(kind).folders[0])
    words = {**meanings()["all"], **meanings().get(kind, {})}
    return tuple(
        SheetKey(path, known.type, known.default, text, known.example)
        for path, text in words.items()
        if (known := asked.get(path)) is not None
    )


def budget_keys() -> Iterator[SheetKey]:
    """Yields the keys under ``budget``."""
    for (name, meaning), default in zip(
        budget_lines(),
        (*(f"{key.default():g}" for key in BUDGET_KEYS), "what its episodes take"),
        strict=True,
    ):
        yield SheetKey(f"budget.{name}", "number", default, re.sub(r"; [^;]*$", "", meaning), "")


def documented_attributes(record: type) -> Iterator[tuple[str, str]]:
    """Yields the fields and properties of a class that have a docstring, with it, in the order in which they are written."""
    (tree,) = ast.parse(textwrap.dedent(inspect.getsource(record))).body
    assert isinstance(tree, ast.ClassDef)  # the source of a class
    for node, after in zip_longest(tree.body, tree.body[1:]):
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            text = f"{' '.join(_text_of(after).split())} ({ast.unparse(node.annotation)})"
            yield node.target.id, text.strip()
        elif isinstance(node, ast.FunctionDef) and node.decorator_list and (told := ast.get_docstring(node)):
            yield node.name, " ".join(told.split())


def _text_of(node: ast.stmt | None) -> str:
    """The docstring that stands as a statement; empty if the statement is none."""
    if (
        isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
    ):
        return node.value.value
    return ""
