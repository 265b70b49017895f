"""Reads a mapping of a YAML file into typed values, noting every mistake with its location.

A reader asks a ``Section`` for each key it knows, then calls ``finish()``. Nothing raises on the way: a
getter notes a ``Problem`` and returns a value of the right type, so one pass finds every mistake.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from enum import Enum
from types import MappingProxyType
from typing import Final, TypeVar, overload

from kit.geometry import Pose
from kit.plain_text import is_printable, nearest_name, quoted, suggestion
from kit.world.problems import ProblemCollector
from kit.world.records import Color, SourceLocation
from kit.world.yaml_tree import (
    ListNode,
    MapNode,
    Node,
    ScalarNode,
    parse_bool,
    parse_integer,
    parse_number,
    to_python,
)
from kit.yaml_numbers import ambiguity

MAX_NUMBER = 1e12
"""No quantity of a flat world is larger, and nothing computed from smaller ones overflows."""

OPEN_BOUND_EPSILON = 1e-9
"""Smallest distance of a number above an open bound, so that dividing by it cannot overflow."""

MAX_INTEGER = 2**31 - 1
"""The largest whole number where no greater ``maximum`` is given."""

T = TypeVar("T")


class Required(Enum):
    """The default of a key that has none: leaving it out is a mistake."""

    REQUIRED = "required"


REQUIRED: Final = Required.REQUIRED


def _is_broken(node: Node) -> bool:
    return isinstance(node, ScalarNode) and node.is_broken


def _describe_node(node: Node) -> str:
    """Describes the node briefly for "must be X, not ..."."""
    if isinstance(node, ListNode):
        return f"a list of {len(node.items)}"
    if isinstance(node, MapNode):
        return "a mapping"
    if node.display_text is not None:
        return node.display_text
    return "nothing" if node.is_null else quoted(node.text)


class Section:
    """A mapping of a YAML file while it is being read.

    ``silent``: the section stands for one that is missing (which was already noted); its getters return
    values and note nothing.
    """

    def __init__(self, node: MapNode, problems: ProblemCollector, *, is_silent: bool = False) -> None:
        self._entries = node.entries
        self._problems = problems
        self._is_silent = is_silent
        self._requested: set[str] = set()
        self._missing_required: set[str] = set()
        self.location: SourceLocation = node.location

    def has(self, key: str) -> bool:
        """Returns whether the key is written in the file. Asking makes it a known key."""
        self._requested.add(key)
        return key in self._entries

    def is_blank(self, key: str) -> bool:
        """Returns whether the key is missing, or nothing stands behind it. Asking makes it a known key."""
        if not self.has(key):
            return True
        value = self._entries[key].value
        return isinstance(value, ScalarNode) and value.is_plain and value.is_null

    def is_list(self, key: str) -> bool:
        """Returns whether a list stands behind the key. Asking makes it a known key."""
        return self.has(key) and isinstance(self._entries[key].value, ListNode)

    def is_mapping(self, key: str) -> bool:
        """Returns whether a mapping stands behind the key. Asking makes it a known key."""
        return self.has(key) and isinstance(self._entries[key].value, MapNode)

    def keys(self) -> tuple[str, ...]:
        """Every key written in the file, in order."""
        return tuple(self._entries)

    def location_of(self, key: str, *, item: int | None = None) -> SourceLocation:
        """Returns the location of the key's value, or of an item of its list; that of the section if the key is missing."""
        if key not in self._entries:
            return self.location
        value = self._entries[key].value
        if isinstance(value, ListNode) and item is not None and item < len(value.items):
            return value.items[item].location
        return value.location

    def error(self, message: str, key: str | None = None, *, item: int | None = None) -> None:
        """Notes a problem at the key's value, or at the section. ``item``: at that item of the key's list."""
        self._report(message, self.location if key is None else self.location_of(key, item=item))

    def text(
        self, key: str, default: str | Required = REQUIRED, *, choices: Collection[str] | None = None
    ) -> str:
        """A scalar as text, perhaps one of ``choices``."""
        text = self._scalar_text(key, default)
        if text is not None and choices is not None and text not in choices:
            self._report_unknown_choice(key, choices)
            text = None
        return _fallback(default, next(iter(choices or [""]))) if text is None else text

    def name(self, key: str, default: str | Required = REQUIRED) -> str:
        """Returns a name: one line, not empty."""
        name = self._scalar_text(key, default)
        if name is None:
            return _fallback(default, "")
        self._check_name(name, key)
        return name

    @overload
    def choice(self, key: str, options: Mapping[str, T]) -> T | None: ...
    @overload
    def choice(self, key: str, options: Mapping[str, T], default: str) -> T: ...
    def choice(self, key: str, options: Mapping[str, T], default: str | Required = REQUIRED) -> T | None:
        """Returns the option that the text selects; None where there is no default and no such option."""
        text = self._scalar_text(key, default)
        if text is not None:
            if text in options:
                return options[text]
            self._report_unknown_choice(key, options)
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
        node = self._node_of(key, default)
        instead = _fallback(default, _number_within(minimum, above, maximum))
        number = None if node is None else self._number(node, quoted(key), infinite=infinite)
        if number is None:
            return instead
        return number if self._is_within_bounds(number, key, minimum, above, maximum) else instead

    def integer(
        self,
        key: str,
        default: int | Required = REQUIRED,
        *,
        minimum: int | None = None,
        maximum: int | None = None,
    ) -> int:
        """A whole number within the bounds."""
        node = self._node_of(key, default)
        instead = _fallback(default, int(_number_within(minimum, None, maximum)))
        if node is None:
            return instead
        integer = _parsed(node, parse_integer)
        if integer is None or abs(integer) > max(MAX_INTEGER, maximum or 0):
            self._report_mismatch(node, f"{quoted(key)} must be a whole number")
            return instead
        return integer if self._is_within_bounds(integer, key, minimum, None, maximum) else instead

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
        """A list of ``at_least`` to ``at_most`` whole numbers within the bounds, exactly as they are written."""
        instead = tuple(_fallback(default, (max(0, minimum),) * (at_least or 0)))
        items = self._list_items(key, default, None, at_least, at_most)
        if items is None:
            return instead
        integers = []
        for i, item in enumerate(items):
            integer = _parsed(item, parse_integer)
            if integer is None or not minimum <= integer <= maximum:
                what = f"{quoted(key)}[{i}] must be a whole number from {minimum} to {maximum}"
                self._report_mismatch(item, what)
                return instead
            integers.append(integer)
        return tuple(integers)

    def flag(self, key: str, default: bool | Required = REQUIRED) -> bool:
        """true or false."""
        node = self._node_of(key, default)
        if node is None:
            return _fallback(default, False)
        flag = parse_bool(node.text) if isinstance(node, ScalarNode) else None
        if flag is None:
            self._report_mismatch(node, f"{quoted(key)} must be true or false")
            return _fallback(default, False)
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
        instead = tuple(_fallback(default, (0.0,) * (length or at_least or 0)))
        items = self._list_items(key, default, length, at_least, at_most)
        if items is None:
            return instead
        numbers = [self._number(item, f"{quoted(key)}[{i}]") for i, item in enumerate(items)]
        return instead if None in numbers else tuple(number for number in numbers if number is not None)

    def points(
        self, key: str, *, at_least: int | None = None, at_most: int | None = None
    ) -> tuple[tuple[float, float], ...]:
        """A list of points ``[x, y]``; without those that are wrong."""
        return tuple((x, y) for x, y in self._rows(key, 2, "a point [x, y]", at_least, at_most))

    def poses(self, key: str, *, at_least: int | None = None, at_most: int | None = None) -> tuple[Pose, ...]:
        """A list of poses ``[x, y, theta]``: m, m, rad; without those that are wrong."""
        return tuple(Pose(*row) for row in self._rows(key, 3, "a pose [x, y, theta]", at_least, at_most))

    def texts(
        self, key: str, default: Sequence[str] | Required = REQUIRED, *, at_least: int | None = None
    ) -> tuple[str, ...]:
        """A list of texts."""
        items = self._list_items(key, default, None, at_least, None)
        if items is None:
            return tuple(_fallback(default, ()))
        texts = [self._text(item, f"{quoted(key)}[{i}]") for i, item in enumerate(items)]
        return tuple(text for text in texts if text is not None)

    def names(self, key: str) -> tuple[str, ...]:
        """A name, or a list of at least one."""
        if isinstance(self._node_of(key, REQUIRED), ListNode):
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
        node = self._node_of(key, default)
        if node is None:
            return None if default is None else self._missing_section(self.location)
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
        items = self._list_items(key, default, length, at_least, None) or ()
        return tuple(self._section(item, f"{quoted(key)}[{i}]") for i, item in enumerate(items))

    def value(self, key: str) -> object:
        """Returns whatever a key holds, as a plain immutable value; None where it is missing or broken."""
        node = self._node_of(key, None)
        return None if node is None else to_python(node)

    def remaining_values(self) -> Mapping[str, object]:
        """Returns the keys not requested so far, as plain immutable values; they count as known from now on."""
        rest = {key: e.value for key, e in self._entries.items() if key not in self._requested}
        self._requested.update(rest)
        for scalar in _scalars(rest.values()):
            if (
                scalar.is_plain
                and parse_integer(scalar.text) is not None
                and (told := ambiguity(scalar.text))
            ):
                self._report(told, scalar.location)
        return MappingProxyType({key: to_python(value) for key, value in rest.items()})

    def finish(self, *, ignore_unknown: bool = False) -> None:
        """Reports every key that was not requested; with ``ignore_unknown`` only those that resemble a missing one."""
        absent = self._requested - self._entries.keys()
        for key, entry in self._entries.items():
            if key in self._requested:
                continue
            if not ignore_unknown:
                self._report(
                    f"unknown key {quoted(key)}: {suggestion(key, absent or self._requested)}", entry.location
                )
            elif (meant := nearest_name(key, self._missing_required)) is not None:
                self._report(f"{quoted(key)} is not used here: did you mean {quoted(meant)}?", entry.location)

    # How the getters take a node apart. Each notes what is wrong and returns None.

    def _report(self, message: str, location: SourceLocation) -> None:
        if not self._is_silent:
            self._problems.add(location, message)

    def _report_mismatch(self, node: Node, demand: str) -> None:
        """Notes that the node is not what is demanded, unless it is broken, which was noted already."""
        if not _is_broken(node):
            told = (
                ambiguity(node.text) if isinstance(node, ScalarNode) and node.display_text is None else None
            )
            self._report(f"{demand}, not {_describe_node(node)}{f': {told}' if told else ''}", node.location)

    def _node_of(self, key: str, default: object) -> Node | None:
        self._requested.add(key)
        entry = self._entries.get(key)
        if entry is None and default is REQUIRED:
            self._missing_required.add(key)
            self.error(f"{quoted(key)} is missing")
        return None if entry is None or _is_broken(entry.value) else entry.value

    def _scalar_text(self, key: str, default: object) -> str | None:
        node = self._node_of(key, default)
        return None if node is None else self._text(node, quoted(key))

    def _list_items(
        self, key: str, default: object, length: int | None, at_least: int | None, at_most: int | None
    ) -> tuple[Node, ...] | None:
        node = self._node_of(key, default)
        if node is None:
            return None
        if not isinstance(node, ListNode):
            self._report_mismatch(node, f"{quoted(key)} must be a list")
            return None
        count = len(node.items)
        for wrong, expected in (
            (length is not None and count != length, f"exactly {length}"),
            (at_least is not None and count < at_least, f"at least {at_least}"),
            (at_most is not None and count > at_most, f"at most {at_most}"),
        ):
            if wrong:
                self.error(f"{quoted(key)} must have {expected} entries, not {count}", key)
                return None
        return node.items

    def _rows(
        self, key: str, length: int, expected: str, at_least: int | None, at_most: int | None
    ) -> Iterator[tuple[float, ...]]:
        """The lists of ``length`` numbers in a list, without those that are wrong."""
        for i, item in enumerate(self._list_items(key, REQUIRED, None, at_least, at_most) or ()):
            what = f"{quoted(key)}[{i}]"
            if not isinstance(item, ListNode) or len(item.items) != length:
                self._report_mismatch(item, f"{what} must be {expected}")
                continue
            numbers = [self._number(each, what) for each in item.items]
            if None not in numbers:
                yield tuple(number for number in numbers if number is not None)

    def _text(self, node: Node, what: str) -> str | None:
        if not isinstance(node, ScalarNode) or node.is_null:
            self._report_mismatch(node, f"{what} must be text")
            return None
        if not is_printable(node.text.replace("\n", "")):
            self._report_mismatch(node, f"{what} must not contain control characters")
            return None
        return node.text

    def _report_unknown_choice(self, key: str, choices: Collection[str]) -> None:
        node = self._entries[key].value
        hint = suggestion(node.text if isinstance(node, ScalarNode) else "", choices)
        self.error(f"{quoted(key)} cannot be {_describe_node(node)}: {hint}", key)

    def _check_name(self, name: str, key: str) -> None:
        if not name.strip() or "\n" in name:
            self.error(f"{quoted(key)} must be a name: one line, not empty", key)

    def _number(self, node: Node, what: str, *, infinite: bool = False) -> float | None:
        number = _parsed(node, parse_number)
        if number is None:
            self._report_mismatch(node, f"{what} must be a number")
            return None
        if infinite and math.isinf(number):
            return number
        if not abs(number) <= MAX_NUMBER:  # NaN too
            self._report_mismatch(node, f"{what} must be a number of at most {MAX_NUMBER:g}")
            return None
        return number

    def _is_within_bounds(
        self, number: float, key: str, minimum: float | None, above: float | None, maximum: float | None
    ) -> bool:
        for wrong, expected in (
            (minimum is not None and number < minimum, f"at least {minimum}"),
            (above is not None and number <= above, f"greater than {above}"),
            (
                above is not None and number < above + OPEN_BOUND_EPSILON,
                f"greater than {above} by {OPEN_BOUND_EPSILON:g} or more",
            ),
            (maximum is not None and number > maximum, f"at most {maximum}"),
        ):
            if wrong:
                self._report_mismatch(self._entries[key].value, f"{quoted(key)} must be {expected}")
                return False
        return True

    def _section(self, node: Node, what: str) -> Section:
        if isinstance(node, MapNode):
            return Section(node, self._problems, is_silent=self._is_silent)
        self._report_mismatch(node, f"{what} must be a mapping (name: value)")
        return self._missing_section(node.location)

    def _missing_section(self, location: SourceLocation) -> Section:
        return Section(MapNode(MappingProxyType({}), location, height=1), self._problems, is_silent=True)


def _parsed(node: Node, parse: Callable[[str], T | None]) -> T | None:
    """The number that a scalar spells; None where it spells none, or one that can be read in two ways."""
    return parse(node.text) if isinstance(node, ScalarNode) and ambiguity(node.text) is None else None


def _scalars(nodes: Iterable[Node]) -> Iterator[ScalarNode]:
    """All scalars in the nodes, and in what they hold."""
    for node in nodes:
        if isinstance(node, ScalarNode):
            yield node
        elif isinstance(node, ListNode):
            yield from _scalars(node.items)
        else:
            yield from _scalars(entry.value for entry in node.entries.values())


def _fallback(default: T | Required, otherwise: T) -> T:
    """Returns the value to continue with when the file has no usable one."""
    return otherwise if isinstance(default, Required) else default


def _number_within(minimum: float | None, above: float | None, maximum: float | None) -> float:
    """Some number within the bounds."""
    low = minimum if minimum is not None else (0.0 if above is None else above + 1.0)
    return low if maximum is None else min(low, maximum)
