"""The keys of a YAML format, as its own reader asks for them: the reader is run on a section that notes every question.

A page of the format and the tests of that page are made from this, so that neither can differ from what is read.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Final, TypeVar, overload

from kit.geometry import Pose
from kit.world.problems import ProblemCollector
from kit.world.records import Color, SourceLocation
from kit.world.yaml_section import REQUIRED, Required, Section
from kit.world.yaml_tree import MapNode

T = TypeVar("T")

OWN_NAME: Final = "NAME"
"""Stands for the keys of a mapping whose names are the writer's own: ``arguments.NAME``."""
SHOWN_ITEMS: Final = 4
"""A longer default of equal numbers is counted instead."""


@dataclass(frozen=True, slots=True)
class FormatKey:
    """One key of a format."""

    key: str
    """With those of the mappings around it: ``angle.min``; ``bodies[].name`` in every entry of a list."""
    type: str
    """What may stand behind it, with its bounds."""
    default: str | None
    """As it would be written, or "none"; None where the key may not be left out."""
    only_with: str = ""
    """The choice that must be made elsewhere for the key to be known: ``type: circle``."""


@dataclass(slots=True)
class _Run:
    """One run of a reader, and what it asked for."""

    decided: Mapping[str, str]
    """The options that choices take in it, by key."""
    absent: str = ""
    """A key that is not written in it."""
    keys: dict[str, FormatKey] = field(default_factory=dict)
    choices: dict[str, tuple[str, ...]] = field(default_factory=dict)

    guarded: set[str] = field(default_factory=set)
    """Keys that the reader asks for only where they are written."""

    def note(self, key: str, type_: str, default: object) -> None:
        """Notes a question; where one getter asks another, the first one knows more."""
        written = "none" if key in self.guarded else _yaml_text(default)
        self.keys.setdefault(key, FormatKey(key, type_, written))

    def option(self, choice: str) -> str:
        """What a choice takes in it; empty where it does not have the choice."""
        return self.decided.get(choice, self.choices.get(choice, ("",))[0])


def format_keys(
    read: Callable[[Section], object], alternatives: Mapping[str, Sequence[str]] = MappingProxyType({})
) -> tuple[FormatKey, ...]:
    """All keys that ``read`` can ask for, in the order of its questions, whatever is chosen and whatever is not written.

    ``alternatives``: texts by which the reader tells cases apart although any other text is allowed too.

    >>> def read(section: Section) -> None:
    ...     section.number("radius", 1.0, above=0)
    >>> format_keys(read)
    (FormatKey(key='radius', type='number, greater than 0', default='1', only_with=''),)
    """
    runs: list[_Run] = []
    pending = [_Run({})]
    tried: set[tuple[str, str]] = set()
    left_out: set[str] = set()
    while pending:
        run = pending.pop(0)
        read(_NotingSection(run, "", alternatives))
        runs.append(run)
        for key in sorted(run.guarded - left_out):  # the reader may ask for others in its place
            left_out.add(key)
            pending.append(_Run(run.decided, key))
        for key, options in run.choices.items():
            for option in options:
                if key not in run.decided and (key, option) not in tried:
                    tried.add((key, option))
                    pending.append(_Run({**run.decided, key: option}))
    return tuple(_merged(runs))


def _merged(runs: Sequence[_Run]) -> Iterator[FormatKey]:
    """The keys of all runs, each in the place that it has in the run that knows it first."""
    order: list[str] = []
    for run in runs:
        at = 0
        for key in run.keys:
            if key in order:
                at = order.index(key) + 1
            else:
                order.insert(at, key)
                at += 1
    for key in order:
        known = [run for run in runs if key in run.keys]
        found = known[0].keys[key]
        yield FormatKey(found.key, found.type, found.default, _deciding_choice(key, known, runs))


def _deciding_choice(key: str, known: Sequence[_Run], runs: Sequence[_Run]) -> str:
    """The choice that tells the runs which know the key from those that do not."""
    unknown = [run for run in runs if key not in run.keys and run.absent != key]
    for name in dict.fromkeys(name for run in known for name in run.choices):
        options = {run.option(name) for run in known}
        if unknown and not options & {run.option(name) for run in unknown}:
            return f"{name.rpartition('.')[2]}: {' or '.join(sorted(options))}"
    return ""


class _NotingSection(Section):
    """An empty mapping that answers every question as if it were well, and notes it."""

    def __init__(self, run: _Run, prefix: str, alternatives: Mapping[str, Sequence[str]]) -> None:
        nothing = MapNode(MappingProxyType({}), SourceLocation(Path("format.yaml")), height=1)
        super().__init__(nothing, ProblemCollector(), is_silent=True)
        self._run, self._prefix, self._alternatives = run, prefix, alternatives

    def _note(self, key: str, type_: str, default: object = REQUIRED) -> None:
        self._run.note(self._prefix + key, type_, default)

    def keys(self) -> tuple[str, ...]:
        """One key, which stands for all names that are the writer's own."""
        return (OWN_NAME,)

    def has(self, key: str) -> bool:
        self._run.guarded.add(self._prefix + key)
        return self._prefix + key != self._run.absent

    def is_blank(self, key: str) -> bool:
        return False

    def is_list(self, key: str) -> bool:
        return False

    def is_mapping(self, key: str) -> bool:
        return False

    def text(
        self, key: str, default: str | Required = REQUIRED, *, choices: Collection[str] | None = None
    ) -> str:
        options = tuple(choices or self._alternatives.get(self._prefix + key, ()))
        self._note(key, _one_of(options) if choices else "text", default)
        return self._decide(key, options) if options else super().text(key, default)

    def name(self, key: str, default: str | Required = REQUIRED) -> str:
        self._note(key, "name", default)
        options = tuple(self._alternatives.get(self._prefix + key, ()))
        return self._decide(key, options) if options else super().name(key, default)

    @overload
    def choice(self, key: str, options: Mapping[str, T]) -> T | None: ...
    @overload
    def choice(self, key: str, options: Mapping[str, T], default: str) -> T: ...
    def choice(self, key: str, options: Mapping[str, T], default: str | Required = REQUIRED) -> T | None:
        self._note(key, _one_of(options), default)
        return options[self._decide(key, tuple(options))]

    def _decide(self, key: str, options: tuple[str, ...]) -> str:
        """The option that this run takes."""
        self._run.choices[self._prefix + key] = options
        return self._run.decided.get(self._prefix + key, options[0])

    def number(
        self,
        key: str,
        default: float | Required = REQUIRED,
        *,
        minimum: float | None = None,
        above: float | None = None,
        maximum: float | None = None,
        infinite: bool = False,
    ) -> float:
        self._note(key, f"number{_bounds(minimum, above, maximum)}", default)
        return super().number(key, default, minimum=minimum, above=above, maximum=maximum, infinite=infinite)

    def integer(
        self,
        key: str,
        default: int | Required = REQUIRED,
        *,
        minimum: int | None = None,
        maximum: int | None = None,
    ) -> int:
        self._note(key, f"whole number{_bounds(minimum, None, maximum)}", default)
        return super().integer(key, default, minimum=minimum, maximum=maximum)

    def integers(
        self,
        key: str,
        default: Sequence[int] | Required = REQUIRED,
        *,
        minimum: int,
        maximum: int,
        at_least: int | None = None,
        at_most: int | None = None,
    ) -> tuple[int, ...]:
        self._note(key, f"list of whole numbers{_bounds(minimum, None, maximum)}", default)
        return super().integers(
            key, default, minimum=minimum, maximum=maximum, at_least=at_least, at_most=at_most
        )

    def flag(self, key: str, default: bool | Required = REQUIRED) -> bool:
        self._note(key, "true or false", default)
        return super().flag(key, default)

    def numbers(
        self,
        key: str,
        default: Sequence[float] | Required = REQUIRED,
        *,
        length: int | None = None,
        at_least: int | None = None,
        at_most: int | None = None,
    ) -> tuple[float, ...]:
        self._note(key, f"list of {_length_words(length, at_least, at_most)}numbers", default)
        return super().numbers(key, default, length=length, at_least=at_least, at_most=at_most)

    def points(
        self, key: str, *, at_least: int | None = None, at_most: int | None = None
    ) -> tuple[tuple[float, float], ...]:
        self._note(key, f"list of {_length_words(None, at_least, at_most)}points [x, y]")
        return super().points(key, at_least=at_least, at_most=at_most)

    def poses(self, key: str, *, at_least: int | None = None, at_most: int | None = None) -> tuple[Pose, ...]:
        self._note(key, f"list of {_length_words(None, at_least, at_most)}poses [x, y, theta]")
        return super().poses(key, at_least=at_least, at_most=at_most)

    def texts(
        self, key: str, default: Sequence[str] | Required = REQUIRED, *, at_least: int | None = None
    ) -> tuple[str, ...]:
        self._note(key, f"list of {_length_words(None, at_least, None)}names", default)
        return super().texts(key, default, at_least=at_least)

    def names(self, key: str) -> tuple[str, ...]:
        self._note(key, "name, or a list of names")
        return super().names(key)

    def color(self, key: str, default: Color) -> Color:
        self._note(key, "[red, green, blue, alpha], each 0 to 1", default)
        return super().color(key, default)

    def point(self, key: str, default: tuple[float, float] | Required = REQUIRED) -> tuple[float, float]:
        self._note(key, "point [x, y]", default)
        return super().point(key, default)

    def pose(self, key: str, default: Pose | Required = REQUIRED) -> Pose:
        self._note(key, "pose [x, y, theta]", default)
        return super().pose(key, default)

    @overload
    def section(self, key: str) -> Section: ...
    @overload
    def section(self, key: str, default: None) -> Section | None: ...
    def section(self, key: str, default: Required | None = REQUIRED) -> Section | None:
        if default is None and self._prefix + key == self._run.absent:
            return None
        self._note(key, "mapping", {} if default is None else default)
        return _NotingSection(self._run, f"{self._prefix}{key}.", self._alternatives)

    def sections(
        self,
        key: str,
        default: tuple[()] | Required = REQUIRED,
        *,
        length: int | None = None,
        at_least: int | None = None,
    ) -> tuple[Section, ...]:
        self._note(key, f"list of {_length_words(length, at_least, None)}mappings", default)
        entry = _NotingSection(self._run, f"{self._prefix}{key}[].", self._alternatives)
        return (entry,) * (length or 1)


def _bounds(minimum: float | None, above: float | None, maximum: float | None) -> str:
    said = (
        "" if minimum is None else f"at least {minimum:g}",
        "" if above is None else f"greater than {above:g}",
        "" if maximum is None else f"at most {maximum:g}",
    )
    return "".join(f", {each}" for each in said if each)


def _length_words(length: int | None, at_least: int | None, at_most: int | None) -> str:
    if length is not None:
        return f"{length} "
    if at_least is not None and at_most is not None:
        return f"{at_least} to {at_most} "
    return "".join(
        f"{word} {count} "
        for word, count in (("at least", at_least), ("at most", at_most))
        if count is not None
    )


def _one_of(options: Collection[str]) -> str:
    return f"one of {', '.join(options)}"


def _yaml_text(default: object) -> str | None:
    """A default as YAML has it."""
    match default:
        case Required():
            return None
        case bool():
            return str(default).lower()
        case int() | float():
            return ".inf" if math.isinf(default) else f"{default:g}"
        case str():
            return default or '""'
        case dict():
            return "{}"
        case _:
            items = (
                [_yaml_text(item) for item in default] if isinstance(default, Sequence) else [str(default)]
            )
            if len(items) > SHOWN_ITEMS and len(set(items)) == 1:
                return f"{len(items)} times {items[0]}"
            return f"[{', '.join(str(item) for item in items)}]"


_RULE: Final = re.compile(r"^ *(=+)  ?=+$", re.MULTILINE)


def key_meanings(documentation: str) -> dict[str, str]:
    """What the table in a reader's documentation says of each key.

    >>> key_meanings('''A box.
    ...
    ...     ==== =============
    ...     a, b lengths of
    ...          its sides [m]
    ...     ==== =============
    ... ''')
    {'a': 'lengths of its sides [m]', 'b': 'lengths of its sides [m]'}
    """
    rules = list(_RULE.finditer(documentation))
    if len(rules) < 2:
        return {}
    width, indent = len(rules[0][1]), rules[0].start(1) - rules[0].start()
    rows: list[tuple[str, list[str]]] = []
    for line in documentation[rules[0].end() : rules[1].start()].splitlines():
        names, meaning = line[indent : indent + width].strip(), line[indent + width :].strip()
        if names:
            rows.append((names, [meaning]))
        elif meaning:
            rows[-1][1].append(meaning)
    return {key: " ".join(parts) for names, parts in rows for key in names.split(", ")}
