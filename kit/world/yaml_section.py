"""How a mapping of a YAML file becomes typed values, with every mistake noted at its place.

A reader asks a ``Section`` for each key it knows, then calls ``finish()``. Nothing raises on the way: a
getter notes a ``Problem`` and returns a value of the right type, so one pass finds every mistake.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from enum import Enum
from types import MappingProxyType
from typing import Final, TypeVar, overload

from kit.geometry import Pose
from kit.world.problems import Problems, displayable, nearest, quoted, suggestion
from kit.world.records import Color, Place
from kit.world.yaml_tree import Leaf, ListNode, MapNode, Node, as_flag, as_integer, as_number, plain_value

MAX_NUMBER = 1e12
"""No quantity of a flat world is larger, and nothing computed from smaller ones overflows."""

HAIR = 1e-9
"""How far above an open bound a number must be, so that nothing divided by it overflows either."""

MAX_INTEGER = 2**31 - 1

T = TypeVar("T")


class Required(Enum):
    """The default of a key that has none: leaving it out is a mistake."""

    REQUIRED = "required"


REQUIRED: Final = Required.REQUIRED


def _is_broken(node: Node) -> bool:
    return isinstance(node, Leaf) and node.broken


def _shown(node: Node) -> str:
    """What stands in the file, in a few words, for "expected X, found ..."."""
    if isinstance(node, ListNode):
        return f"a list of {len(node.items)}"
    if isinstance(node, MapNode):
        return "a mapping"
    if node.shown_as is not None:
        return node.shown_as
    return "nothing" if node.is_null else quoted(node.text)


class Section:
    """A mapping of a YAML file while it is being read.

    ``silent``: the section stands for one that is missing (which was already noted); its getters return
    values and note nothing.
    """

    def __init__(self, node: MapNode, problems: Problems, *, silent: bool = False) -> None:
        self._entries = node.entries
        self._problems = problems
        self._silent = silent
        self._asked: set[str] = set()
        self._missing: set[str] = set()
        self.place: Place = node.place

    def has(self, key: str) -> bool:
        """Whether the key is written in the file. Asking makes it a known key."""
        self._asked.add(key)
        return key in self._entries

    def is_blank(self, key: str) -> bool:
        """Whether the key is missing, or nothing stands behind it. Asking makes it a known key."""
        if not self.has(key):
            return True
        value = self._entries[key].value
        return isinstance(value, Leaf) and value.plain and value.is_null

    def keys(self) -> tuple[str, ...]:
        """Every key written in the file, in order."""
        return tuple(self._entries)

    def place_of(self, key: str) -> Place:
        """Where the key's value stands; where the section stands if the key is missing."""
        entry = self._entries.get(key)
        return self.place if entry is None else entry.value.place

    def error(self, message: str, key: str | None = None) -> None:
        """Notes a problem at the key's value, or at the section."""
        self._error(message, self.place if key is None else self.place_of(key))

    def text(
        self, key: str, default: str | Required = REQUIRED, *, choices: Collection[str] | None = None
    ) -> str:
        """A scalar as text, perhaps one of ``choices``."""
        text = self._written(key, default)
        if text is not None and choices is not None and text not in choices:
            self._not_one_of(key, choices)
            text = None
        return _instead(default, next(iter(choices or [""]))) if text is None else text

    def name(self, key: str, default: str | Required = REQUIRED) -> str:
        """A text by which something is called: one line, not empty."""
        name = self._written(key, default)
        if name is None:
            return _instead(default, "")
        self._check_name(name, key)
        return name

    @overload
    def choice(self, key: str, options: Mapping[str, T]) -> T | None: ...
    @overload
    def choice(self, key: str, options: Mapping[str, T], default: str) -> T: ...
    def choice(self, key: str, options: Mapping[str, T], default: str | Required = REQUIRED) -> T | None:
        """What the text stands for in the table ``options``; None where there is no default and no such text."""
        text = self._written(key, default)
        if text is not None:
            if text in options:
                return options[text]
            self._not_one_of(key, options)
        return None if isinstance(default, Required) else options[default]

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
        """A finite number (or, with ``infinite``, also ``.inf``) within the bounds, of which ``above`` is open."""
        node = self._value(key, default)
        instead = _instead(default, _within(minimum, above, maximum))
        number = None if node is None else self._number(node, quoted(key), infinite=infinite)
        if number is None:
            return instead
        return number if self._bounded(number, key, minimum, above, maximum) else instead

    def integer(
        self,
        key: str,
        default: int | Required = REQUIRED,
        *,
        minimum: int | None = None,
        maximum: int | None = None,
    ) -> int:
        """A whole number within the bounds."""
        node = self._value(key, default)
        instead = _instead(default, int(_within(minimum, None, maximum)))
        if node is None:
            return instead
        integer = as_integer(node.text) if isinstance(node, Leaf) else None
        if integer is None or abs(integer) > MAX_INTEGER:
            self._reject(node, f"{quoted(key)} must be a whole number")
            return instead
        return integer if self._bounded(integer, key, minimum, None, maximum) else instead

    def flag(self, key: str, default: bool | Required = REQUIRED) -> bool:
        """true or false."""
        node = self._value(key, default)
        if node is None:
            return _instead(default, False)
        flag = as_flag(node.text) if isinstance(node, Leaf) else None
        if flag is None:
            self._reject(node, f"{quoted(key)} must be true or false")
            return _instead(default, False)
        return flag

    def numbers(
        self,
        key: str,
        default: Sequence[float] | Required = REQUIRED,
        *,
        length: int | None = None,
        at_least: int | None = None,
        at_most: int | None = None,
    ) -> tuple[float, ...]:
        """A list of finite numbers, of exactly ``length`` or of ``at_least`` to ``at_most``."""
        instead = tuple(_instead(default, (0.0,) * (length or at_least or 0)))
        items = self._items(key, default, length, at_least, at_most)
        if items is None:
            return instead
        numbers = [self._number(item, f"{quoted(key)}[{i}]") for i, item in enumerate(items)]
        return instead if None in numbers else tuple(number for number in numbers if number is not None)

    def points(
        self, key: str, *, at_least: int | None = None, at_most: int | None = None
    ) -> tuple[tuple[float, float], ...]:
        """A list of points ``[x, y]``; without those that are wrong."""
        points = []
        for i, item in enumerate(self._items(key, REQUIRED, None, at_least, at_most) or ()):
            what = f"{quoted(key)}[{i}]"
            if not isinstance(item, ListNode) or len(item.items) != 2:
                self._reject(item, f"{what} must be a point [x, y]")
                continue
            x, y = (self._number(coordinate, what) for coordinate in item.items)
            if x is not None and y is not None:
                points.append((x, y))
        return tuple(points)

    def texts(
        self, key: str, default: Sequence[str] | Required = REQUIRED, *, at_least: int | None = None
    ) -> tuple[str, ...]:
        """A list of texts."""
        items = self._items(key, default, None, at_least, None)
        if items is None:
            return tuple(_instead(default, ()))
        texts = [self._text(item, f"{quoted(key)}[{i}]") for i, item in enumerate(items)]
        return tuple(text for text in texts if text is not None)

    def names(self, key: str) -> tuple[str, ...]:
        """A name, or a list of at least one."""
        if isinstance(self._value(key, REQUIRED), ListNode):
            names = self.texts(key, at_least=1)
            for name in names:
                self._check_name(name, key)
            return names
        return (self.name(key),)

    def color(self, key: str, default: Color) -> Color:
        """Four numbers: red, green, blue, alpha; each is brought into 0 to 1."""
        red, green, blue, alpha = (min(max(part, 0.0), 1.0) for part in self.numbers(key, default, length=4))
        return red, green, blue, alpha

    def point(self, key: str, default: tuple[float, float] | Required = REQUIRED) -> tuple[float, float]:
        """``[x, y]``: metres."""
        x, y = self.numbers(key, default, length=2)
        return x, y

    def pose(self, key: str, default: Pose | Required = REQUIRED) -> Pose:
        """``[x, y, theta]``: m, m, rad."""
        return Pose(*self.numbers(key, default, length=3))

    @overload
    def section(self, key: str) -> Section: ...
    @overload
    def section(self, key: str, default: None) -> Section | None: ...
    def section(self, key: str, default: Required | None = REQUIRED) -> Section | None:
        """A mapping; None where the key is missing and ``default`` is None."""
        node = self._value(key, default)
        if node is None:
            return None if default is None else self._absent(self.place)
        return self._section(node, quoted(key))

    def sections(
        self,
        key: str,
        default: tuple[()] | Required = REQUIRED,
        *,
        length: int | None = None,
        at_least: int | None = None,
    ) -> tuple[Section, ...]:
        """A list of mappings."""
        items = self._items(key, default, length, at_least, None) or ()
        return tuple(self._section(item, f"{quoted(key)}[{i}]") for i, item in enumerate(items))

    def rest(self) -> Mapping[str, object]:
        """The keys nobody asked for, as plain immutable values; they count as known from now on."""
        rest = {key: e.value for key, e in self._entries.items() if key not in self._asked}
        self._asked.update(rest)
        return MappingProxyType({key: plain_value(value) for key, value in rest.items()})

    def finish(self, *, ignore_unknown: bool = False) -> None:
        """Notes every key that nobody asked for; with ``ignore_unknown`` only those that look like a missing one."""
        absent = self._asked - self._entries.keys()
        for key, entry in self._entries.items():
            if key in self._asked:
                continue
            if not ignore_unknown:
                self._error(
                    f"unknown key {quoted(key)}: {suggestion(key, absent or self._asked)}", entry.place
                )
            elif (meant := nearest(key, self._missing)) is not None:
                self._error(f"{quoted(key)} is not read here: did you mean {quoted(meant)}?", entry.place)

    # How the getters take a node apart. Each notes what is wrong and returns None.

    def _error(self, message: str, place: Place) -> None:
        if not self._silent:
            self._problems.add(place, message)

    def _reject(self, node: Node, demand: str) -> None:
        """Notes that the node is not what is demanded, unless it is broken, which was noted already."""
        if not _is_broken(node):
            self._error(f"{demand}, not {_shown(node)}", node.place)

    def _value(self, key: str, default: object) -> Node | None:
        self._asked.add(key)
        entry = self._entries.get(key)
        if entry is None and default is REQUIRED:
            self._missing.add(key)
            self.error(f"{quoted(key)} is missing")
        return None if entry is None or _is_broken(entry.value) else entry.value

    def _written(self, key: str, default: object) -> str | None:
        node = self._value(key, default)
        return None if node is None else self._text(node, quoted(key))

    def _items(
        self, key: str, default: object, length: int | None, at_least: int | None, at_most: int | None
    ) -> tuple[Node, ...] | None:
        node = self._value(key, default)
        if node is None:
            return None
        if not isinstance(node, ListNode):
            self._reject(node, f"{quoted(key)} must be a list")
            return None
        count = len(node.items)
        for wrong, wanted in (
            (length is not None and count != length, f"exactly {length}"),
            (at_least is not None and count < at_least, f"at least {at_least}"),
            (at_most is not None and count > at_most, f"at most {at_most}"),
        ):
            if wrong:
                self.error(f"{quoted(key)} must have {wanted} entries, not {count}", key)
                return None
        return node.items

    def _text(self, node: Node, what: str) -> str | None:
        if not isinstance(node, Leaf) or node.is_null:
            self._reject(node, f"{what} must be a text")
            return None
        if not displayable(node.text.replace("\n", "")):
            self._reject(node, f"{what} must be without control characters")
            return None
        return node.text

    def _not_one_of(self, key: str, choices: Collection[str]) -> None:
        node = self._entries[key].value
        hint = suggestion(node.text if isinstance(node, Leaf) else "", choices)
        self.error(f"{quoted(key)} cannot be {_shown(node)}: {hint}", key)

    def _check_name(self, name: str, key: str) -> None:
        if not name.strip() or "\n" in name:
            self.error(f"{quoted(key)} must be a name: one line, not empty", key)

    def _number(self, node: Node, what: str, *, infinite: bool = False) -> float | None:
        number = as_number(node.text) if isinstance(node, Leaf) else None
        if number is None:
            self._reject(node, f"{what} must be a number")
            return None
        if infinite and math.isinf(number):
            return number
        if not abs(number) <= MAX_NUMBER:  # NaN too
            self._reject(node, f"{what} must be a number of at most {MAX_NUMBER:g}")
            return None
        return number

    def _bounded(
        self, number: float, key: str, minimum: float | None, above: float | None, maximum: float | None
    ) -> bool:
        for wrong, wanted in (
            (minimum is not None and number < minimum, f"at least {minimum}"),
            (above is not None and number <= above, f"greater than {above}"),
            (above is not None and number < above + HAIR, f"greater than {above} by {HAIR:g} or more"),
            (maximum is not None and number > maximum, f"at most {maximum}"),
        ):
            if wrong:
                self._reject(self._entries[key].value, f"{quoted(key)} must be {wanted}")
                return False
        return True

    def _section(self, node: Node, what: str) -> Section:
        if isinstance(node, MapNode):
            return Section(node, self._problems, silent=self._silent)
        self._reject(node, f"{what} must be a mapping")
        return self._absent(node.place)

    def _absent(self, place: Place) -> Section:
        return Section(MapNode(MappingProxyType({}), place, height=1), self._problems, silent=True)


def _instead(default: T | Required, otherwise: T) -> T:
    """The value to go on with when the file gives none that can be used."""
    return otherwise if isinstance(default, Required) else default


def _within(minimum: float | None, above: float | None, maximum: float | None) -> float:
    """Some number within the bounds."""
    low = minimum if minimum is not None else (0.0 if above is None else above + 1.0)
    return low if maximum is None else min(low, maximum)
