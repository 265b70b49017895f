"""The elements of a launch file in XML or YAML: a tag, attributes, children, and where each is written."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Final, NamedTuple

from kit.plain_text import nearest_name
from kit.ros.launch.context import LaunchError, LaunchFileLocation
from kit.ros.launch.frontend.substitution_parser import SubstitutionSyntaxError, parse_substitutions
from kit.ros.launch.substitutions import Substitution

Texts = list[Substitution]


class TextPosition(NamedTuple):
    """Line and column, counted from 1."""

    line: int
    column: int


class Problems:
    """The mistakes of one file, collected so that they are all reported at once."""

    def __init__(self, file: str) -> None:
        self.file = file
        self._found: list[tuple[TextPosition, str]] = []

    def add(self, place: TextPosition, text: str) -> None:
        """Adds a mistake."""
        self._found.append((place, text))

    def raise_if_any(self) -> None:
        """Raises LaunchError at the first mistake; its message holds all of them."""
        if not self._found:
            return
        (first, text), *others = sorted(self._found)
        lines = [f"column {first.column}: {text}"]
        lines += [f"{self.file}:{place.line}:{place.column}: {text}" for place, text in others]
        raise LaunchError("\n".join(lines), LaunchFileLocation(self.file, first.line))


_NOTHING: Final = object()


@dataclass(slots=True)
class Element:
    """An element; what is taken from it is known, the rest is reported by ``finish``."""

    tag: str
    place: TextPosition
    problems: Problems
    attributes: dict[str, str] = field(default_factory=dict)
    children: list[Element] = field(default_factory=list)
    _known: set[str] = field(default_factory=set)
    _known_children: set[str] = field(default_factory=set)

    def text(self, name: str, default: Any = _NOTHING) -> Any:
        """An attribute as it is written; ``default``, if given, where there is none."""
        self._known.add(name)
        if name in self.attributes:
            return self.attributes[name]
        if default is _NOTHING:
            self.problem(f"<{self.tag}> needs '{name}'")
            return ""
        return default

    def texts(self, name: str, default: Any = _NOTHING) -> Any:
        """An attribute as substitutions; likewise."""
        value = self.text(name, default)
        return self.parse(value) if isinstance(value, str) and name in self.attributes else value

    def flag(self, name: str, default: bool) -> bool:
        """An attribute that is true or false."""
        value = str(self.text(name, str(default))).lower()
        if value not in ("true", "false", "1", "0"):
            self.problem(f"'{name}' of <{self.tag}> must be true or false, not '{value}'")
        return value in ("true", "1")

    def number(self, name: str, default: float | None) -> float | None:
        """An attribute that is a number."""
        value = self.text(name, None)
        try:
            return default if value is None else float(value)
        except ValueError:
            self.problem(f"'{name}' of <{self.tag}> must be a number, not '{value}'")
            return default

    def take(self, *tags: str) -> list[Element]:
        """The children of these tags."""
        self._known_children.update(tags)
        return [child for child in self.children if child.tag in tags]

    def take_actions(self, *others: str) -> list[Element]:
        """All children but those of the other tags, which are no actions."""
        self._known_children.update(child.tag for child in self.children)
        return [child for child in self.children if child.tag not in others]

    def parse(self, text: str) -> Texts:
        """A text as substitutions."""
        try:
            return parse_substitutions(text)
        except SubstitutionSyntaxError as problem:
            self.problem(f"in '{text[:60]}': {problem}")
            return []

    def problem(self, text: str) -> None:
        self.problems.add(self.place, text)

    def finish(self) -> None:
        """Reports every attribute and child that nobody has taken."""
        for name in self.attributes.keys() - self._known:
            near = nearest_name(name, self._known)
            hint = f"; did you mean '{near}'?" if near else f"; it has {', '.join(sorted(self._known))}"
            self.problem(f"<{self.tag}> has no '{name}'{hint}")
        for child in self.children:
            if child.tag not in self._known_children:
                child.problem(f"<{child.tag}> does not belong in <{self.tag}>")
