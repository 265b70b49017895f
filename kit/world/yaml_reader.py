"""The text of a YAML file as trees that know their places, with a limit on depth and size.

Built from the parser's events, one by one, so that a hostile file is given up while it is being read.
Differences from plain PyYAML, each on purpose: no tags that make objects; a key twice in one mapping is a
mistake; ``<<`` is an ordinary key, as in Flatland's reader; an alias counts for all that it repeats.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import Protocol, TypeAlias

import yaml

from kit.world.preprocessor import Include, Refused, expanded
from kit.world.problems import Problem, Problems, quoted
from kit.world.records import Place
from kit.world.yaml_tree import Entry, Leaf, ListNode, MapNode, Node

MAX_DEPTH = 64
MAX_NODES = 100_000
"""Values in all files of one world together, counted each time a file or an alias is used."""

_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_UNPRINTABLE = re.compile("[^\t\n\r\x20-\x7e\x85\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_IGNORED_TAGS = frozenset(
    f"tag:yaml.org,2002:{name}" for name in ("int", "float", "bool", "null", "seq", "map")
)
_TEXT_TAGS = frozenset({"!", "tag:yaml.org,2002:str"})

Events: TypeAlias = Iterator[yaml.Event]


class _Mark(Protocol):
    """A position in the text as the parser counts, from 0; its two implementations share no class."""

    @property
    def line(self) -> int: ...
    @property
    def column(self) -> int: ...


class NotYaml(Exception):
    """The text cannot be read to its end."""

    def __init__(self, place: Place, message: str) -> None:
        super().__init__(message)
        self.problem = Problem(place, message)


class Budget:
    """How much of MAX_NODES is left."""

    def __init__(self, problems: Problems) -> None:
        self._problems = problems
        self.spent = 0

    def spend(self, nodes: int, place: Place) -> None:
        """Counts values; raises WorldError when there were too many."""
        self.spent += nodes
        if self.spent > MAX_NODES:
            self._problems.add(place, f"too much to read: more than {MAX_NODES} values, repetitions included")
            self._problems.raise_if_any()


class Composer:
    """Composes the documents of one file.

    ``include(name, place, depth)``: the documents of another file, put in where a scalar says so.
    """

    def __init__(
        self,
        file: Path,
        *,
        problems: Problems,
        budget: Budget,
        environment: Mapping[str, str],
        include: Callable[[str, Place, int], tuple[Node, ...]],
    ) -> None:
        self._file = file
        self._problems = problems
        self._budget = budget
        self._environment = environment
        self._include = include
        self._anchors: dict[str, tuple[Node, int]] = {}

    def documents(self, text: str, depth: int = 0) -> Iterator[Node]:
        """Every document of the text, which goes into another one ``depth`` deep.

        Raises NotYaml, and WorldError when the budget is exceeded.
        """
        if found := _UNPRINTABLE.search(text):
            line_start = text.rfind("\n", 0, found.start()) + 1
            place = Place(self._file, text.count("\n", 0, found.start()) + 1, found.start() - line_start + 1)
            raise NotYaml(place, f"not valid YAML: the character {quoted(found[0])} is not allowed")
        try:
            events = iter(yaml.parse(text, Loader=_LOADER))
            for event in events:
                if isinstance(event, yaml.DocumentStartEvent):
                    self._anchors = {}
                    yield self._node(next(events), events, depth)
        except yaml.MarkedYAMLError as error:
            words = ", ".join(word for word in (error.context, error.problem) if word)
            mark = error.problem_mark or error.context_mark
            raise NotYaml(self._place(mark), f"not valid YAML: {words}") from error
        except (yaml.YAMLError, ValueError, OverflowError) as error:  # the last two: an escape beyond Unicode
            raise NotYaml(Place(self._file), "not valid YAML") from error

    def _node(self, event: yaml.Event, events: Events, depth: int) -> Node:
        """The node that starts with ``event``; takes its further events."""
        place = self._place(event.start_mark)
        before = self._budget.spent
        node: Node
        if isinstance(event, yaml.AliasEvent):
            node = self._alias(event, place)
        elif isinstance(event, yaml.ScalarEvent):
            self._budget.spend(1, place)
            scalar = self._scalar(event, place)
            node = scalar if isinstance(scalar, Leaf) else self._included(scalar, place, depth)
        else:
            assert isinstance(event, yaml.CollectionStartEvent), event
            node = self._collection(event, events, depth + 1)
        if depth + node.height > MAX_DEPTH:  # what aliases and includes bring along counts too
            raise NotYaml(place, f"nested more than {MAX_DEPTH} deep")
        if isinstance(event, yaml.NodeEvent) and event.anchor:
            self._anchors[event.anchor] = node, self._budget.spent - before
        return node

    def _collection(self, event: yaml.CollectionStartEvent, events: Events, depth: int) -> ListNode | MapNode:
        place = self._place(event.start_mark)
        if depth > MAX_DEPTH:
            raise NotYaml(place, f"nested more than {MAX_DEPTH} deep")
        self._budget.spend(1, place)
        self._check_tag(event.tag, place)
        if isinstance(event, yaml.SequenceStartEvent):
            items = tuple(self._items(events, depth))
            return ListNode(items, place, 1 + max((item.height for item in items), default=0))
        entries = self._entries(events, depth)
        height = 1 + max((entry.value.height for entry in entries.values()), default=0)
        return MapNode(MappingProxyType(entries), place, height)

    def _items(self, events: Events, depth: int) -> Iterator[Node]:
        for event in events:
            if isinstance(event, yaml.SequenceEndEvent):
                return
            if isinstance(event, yaml.ScalarEvent):
                place = self._place(event.start_mark)
                scalar = self._scalar(event, place)
                if isinstance(scalar, Include) and scalar.spread:
                    yield from self._include(scalar.file, place, depth)
                    continue
            yield self._node(event, events, depth)

    def _entries(self, events: Events, depth: int) -> dict[str, Entry]:
        entries: dict[str, Entry] = {}
        for event in events:
            if isinstance(event, yaml.MappingEndEvent):
                break
            place = self._place(event.start_mark)
            if not isinstance(event, yaml.ScalarEvent):
                raise NotYaml(place, "a key must be a plain word")
            value = self._node(next(events), events, depth)
            if event.value in entries:
                line = entries[event.value].place.line
                self._problems.add(
                    place, f"the key {quoted(event.value)} is here twice: first in line {line}"
                )
            else:
                entries[event.value] = Entry(place, value)
        return entries

    def _scalar(self, event: yaml.ScalarEvent, place: Place) -> Leaf | Include:
        leaf = Leaf(event.value, event.implicit[0] and event.tag not in _TEXT_TAGS, place)
        self._check_tag(event.tag, place)
        try:
            return expanded(leaf, self._environment)
        except Refused as refused:
            self._problems.add(place, str(refused))
            return replace(leaf, broken=True)

    def _included(self, include: Include, place: Place, depth: int) -> Node:
        """The one document that takes the place of a scalar."""
        nodes = self._include(include.file, place, depth)
        if include.spread:
            self._problems.add(place, "$[include] stands in a list only: write $include")
        elif len(nodes) > 1:
            self._problems.add(place, "the file holds several documents: write $[include], in a list")
        return nodes[0] if nodes else Leaf("", True, place, broken=True)

    def _alias(self, event: yaml.AliasEvent, place: Place) -> Node:
        if event.anchor not in self._anchors:
            raise NotYaml(place, f"the alias {quoted(f'*{event.anchor}')} stands for nothing, or for itself")
        node, size = self._anchors[event.anchor]
        self._budget.spend(size, place)
        return node

    def _check_tag(self, tag: str | None, place: Place) -> None:
        if tag is not None and tag not in _TEXT_TAGS and tag not in _IGNORED_TAGS:
            self._problems.add(place, f"the tag {quoted(tag)} means nothing in a world file")

    def _place(self, mark: _Mark | None) -> Place:
        return Place(self._file) if mark is None else Place(self._file, mark.line + 1, mark.column + 1)
