"""Composes YAML text into trees of nodes with locations, within limits of depth and size.

Built from the parser's events, one by one, so that a hostile file is given up while it is being read.
Differences from plain PyYAML, each on purpose: no tags that make objects; a key twice in one mapping is a
mistake; ``<<`` is an ordinary key, as in Flatland's reader; an alias counts for all that it repeats.

Includes and environment variables in scalars are expanded. Flatland also evaluates Lua after ``$eval``. That is
refused, but for the forms that run no code: a call of ``env()`` by itself.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import TypeAlias

import yaml

from kit.plain_text import quoted
from kit.world.problems import Problem, ProblemCollector
from kit.world.records import SourceLocation
from kit.world.yaml_tree import (
    ListNode,
    MapEntry,
    MapNode,
    Node,
    ScalarNode,
    parse_bool,
    parse_number,
)
from kit.yaml_slips import ParserMark, parser_mistake

_INCLUDE = re.compile(r"\$(?P<spread>\[include\]|include)\s+(?P<file>\S.*)", re.DOTALL)
_EVAL = re.compile(r"\$eval\b\s*(return\b)?\s*", re.DOTALL)
_CALL = re.compile(r"(?P<function>env|param)\s*\((?P<arguments>.*)\)", re.DOTALL)
_ARGUMENT = r"""(?:\s*"([^"]*)"\s*|\s*'([^']*)'\s*|([^"',()]*))"""
_ARGUMENTS = re.compile(f"{_ARGUMENT}(,{_ARGUMENT})?")


@dataclass(frozen=True, slots=True)
class IncludeDirective:
    """``$include file``, or with ``spread`` ``$[include] file``: its documents as entries of a list."""

    file: str
    is_list: bool


class RefusedDirective(Exception):
    """A directive that is not carried out; the message says why and what to write instead."""


def expand_directive(leaf: ScalarNode, environment: Mapping[str, str]) -> ScalarNode | IncludeDirective:
    """The leaf, or what it stands for. Raises Refused."""
    if "$" not in leaf.text and "(" not in leaf.text:  # as in nearly all
        return leaf
    text = leaf.text.strip()
    if include := _INCLUDE.fullmatch(text):
        return IncludeDirective(include["file"].strip(), include["spread"] != "include")
    prefix = _EVAL.match(text)
    call = _CALL.fullmatch(text[prefix.end() :] if prefix else text)
    if call and call["function"] == "param":
        raise RefusedDirective(
            "param() needs a ROS parameter server, which the kit does not have: write the value itself"
        )
    if call and (arguments := _ARGUMENTS.fullmatch(call["arguments"])):
        return _from_environment(leaf, arguments, environment)
    if call or prefix:
        raise RefusedDirective(
            "$eval runs Lua code, and a world file must not run code: write the value itself, "
            'or env("NAME", default) for an environment variable'
        )
    if text.startswith(("$include", "$[include]")):
        raise RefusedDirective('the file to include is missing: write "$include file.yaml"')
    return leaf


def _from_environment(
    leaf: ScalarNode, arguments: re.Match[str], environment: Mapping[str, str]
) -> ScalarNode:
    """The variable's value; if there is none the default; if there is none, as in Flatland, an empty text."""
    name = _argument_text(arguments, 1)
    if not name:
        raise RefusedDirective('env() needs the name of an environment variable: env("NAME", default)')
    if name in environment:
        return _with_text(leaf, environment[name], f"the value of the environment variable {quoted(name)}")
    if arguments[4] is not None:
        return _with_text(leaf, _argument_text(arguments, 5), None)
    return _with_text(leaf, "", f"nothing: the environment variable {quoted(name)} is not given")


def _argument_text(arguments: re.Match[str], first: int) -> str:
    """The text of an argument that one of three groups holds: in either kind of quotes, or in none."""
    double, single, bare = arguments.group(first, first + 1, first + 2)
    return next((text for text in (double, single) if text is not None), (bare or "").strip())


def _with_text(leaf: ScalarNode, text: str, shown_as: str | None) -> ScalarNode:
    """The leaf with another text, which is a number, true or false where it spells one."""
    plain = parse_number(text) is not None or parse_bool(text) is not None
    return replace(leaf, text=text, is_plain=plain, display_text=shown_as)


MAX_DEPTH = 64
MAX_NODES = 100_000
"""Values in all files of one world together, counted each time a file or an alias is used."""

_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_UNPRINTABLE = re.compile("[^\t\n\r\x20-\x7e\x85\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_IGNORED_TAGS = frozenset(
    f"tag:yaml.org,2002:{name}" for name in ("int", "float", "bool", "null", "seq", "map")
)
_TEXT_TAGS = frozenset({"!", "tag:yaml.org,2002:str"})

ParserEvents: TypeAlias = Iterator[yaml.Event]


class InvalidYaml(Exception):
    """The text cannot be read to its end."""

    def __init__(self, location: SourceLocation, message: str) -> None:
        super().__init__(message)
        self.problem = Problem(location, message)


class NodeBudget:
    """Counts the values read, up to MAX_NODES."""

    def __init__(self, problems: ProblemCollector) -> None:
        self._problems = problems
        self.spent = 0

    def has_room_for(self, nodes: int) -> bool:
        """Whether this many more values may be read."""
        return self.spent + nodes <= MAX_NODES

    def count(self, nodes: int, location: SourceLocation) -> None:
        """Counts values; raises WorldError when there were too many."""
        self.spent += nodes
        if not self.has_room_for(0):
            self._problems.add(
                location, f"too much to read: more than {MAX_NODES} values, including repetitions"
            )
            self._problems.raise_if_any()


class YamlComposer:
    """Composes the documents of one file.

    ``include(name, place, depth)``: the documents of another file, inserted where a scalar refers to it.
    """

    def __init__(
        self,
        file: Path,
        *,
        problems: ProblemCollector,
        budget: NodeBudget,
        environment: Mapping[str, str],
        include: Callable[[str, SourceLocation, int], tuple[Node, ...]],
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
            location = SourceLocation(
                self._file, text.count("\n", 0, found.start()) + 1, found.start() - line_start + 1
            )
            raise InvalidYaml(location, f"not valid YAML: the character {quoted(found[0])} is not allowed")
        try:
            events = iter(yaml.parse(text, Loader=_LOADER))
            for event in events:
                if isinstance(event, yaml.DocumentStartEvent):
                    self._anchors = {}
                    yield self._compose_node(next(events), events, depth)
        except yaml.MarkedYAMLError as error:
            slip = parser_mistake(error, text)
            location = SourceLocation(self._file, slip.line, slip.column)
            raise InvalidYaml(location, f"not valid YAML: {slip.message}") from error
        except (yaml.YAMLError, ValueError, OverflowError) as error:  # the last two: an escape beyond Unicode
            raise InvalidYaml(SourceLocation(self._file), "not valid YAML") from error

    def _compose_node(self, event: yaml.Event, events: ParserEvents, depth: int) -> Node:
        """The node that starts with ``event``; takes its further events."""
        location = self._location(event.start_mark)
        before = self._budget.spent
        node: Node
        if isinstance(event, yaml.AliasEvent):
            node = self._resolve_alias(event, location)
        elif isinstance(event, yaml.ScalarEvent):
            self._budget.count(1, location)
            scalar = self._compose_scalar(event, location)
            node = scalar if isinstance(scalar, ScalarNode) else self._included_node(scalar, location, depth)
        else:
            assert isinstance(event, yaml.CollectionStartEvent), event
            node = self._compose_collection(event, events, depth + 1)
        if depth + node.height > MAX_DEPTH:  # what aliases and includes bring along counts too
            raise InvalidYaml(location, f"nested more than {MAX_DEPTH} levels deep")
        if isinstance(event, yaml.NodeEvent) and event.anchor:
            self._anchors[event.anchor] = node, self._budget.spent - before
        return node

    def _compose_collection(
        self, event: yaml.CollectionStartEvent, events: ParserEvents, depth: int
    ) -> ListNode | MapNode:
        location = self._location(event.start_mark)
        if depth > MAX_DEPTH:
            raise InvalidYaml(location, f"nested more than {MAX_DEPTH} levels deep")
        self._budget.count(1, location)
        self._check_tag(event.tag, location)
        if isinstance(event, yaml.SequenceStartEvent):
            items = tuple(self._compose_items(events, depth))
            return ListNode(items, location, 1 + max((item.height for item in items), default=0))
        entries = self._compose_entries(events, depth)
        height = 1 + max((entry.value.height for entry in entries.values()), default=0)
        return MapNode(MappingProxyType(entries), location, height)

    def _compose_items(self, events: ParserEvents, depth: int) -> Iterator[Node]:
        for event in events:
            if isinstance(event, yaml.SequenceEndEvent):
                return
            if isinstance(event, yaml.ScalarEvent):
                location = self._location(event.start_mark)
                scalar = self._compose_scalar(event, location)
                if isinstance(scalar, IncludeDirective) and scalar.is_list:
                    yield from self._include(scalar.file, location, depth)
                    continue
            yield self._compose_node(event, events, depth)

    def _compose_entries(self, events: ParserEvents, depth: int) -> dict[str, MapEntry]:
        entries: dict[str, MapEntry] = {}
        for event in events:
            if isinstance(event, yaml.MappingEndEvent):
                break
            location = self._location(event.start_mark)
            if not isinstance(event, yaml.ScalarEvent):
                raise InvalidYaml(location, "a key must be a plain word")
            value = self._compose_node(next(events), events, depth)
            if event.value in entries:
                line = entries[event.value].location.line
                self._problems.add(
                    location, f"the key {quoted(event.value)} appears twice, first on line {line}"
                )
            else:
                entries[event.value] = MapEntry(location, value)
        return entries

    def _compose_scalar(
        self, event: yaml.ScalarEvent, location: SourceLocation
    ) -> ScalarNode | IncludeDirective:
        leaf = ScalarNode(event.value, event.implicit[0] and event.tag not in _TEXT_TAGS, location)
        self._check_tag(event.tag, location)
        try:
            return expand_directive(leaf, self._environment)
        except RefusedDirective as refused:
            self._problems.add(location, str(refused))
            return replace(leaf, is_broken=True)

    def _included_node(self, include: IncludeDirective, location: SourceLocation, depth: int) -> Node:
        """The one document that takes the place of a scalar."""
        nodes = self._include(include.file, location, depth)
        if include.is_list:
            self._problems.add(location, "$[include] works only in a list: write $include")
        elif len(nodes) > 1:
            self._problems.add(location, "the file contains several documents: write $[include] in a list")
        return nodes[0] if nodes else ScalarNode("", True, location, is_broken=True)

    def _resolve_alias(self, event: yaml.AliasEvent, location: SourceLocation) -> Node:
        if event.anchor not in self._anchors:
            raise InvalidYaml(
                location, f"the alias {quoted(f'*{event.anchor}')} is undefined, or refers to itself"
            )
        node, size = self._anchors[event.anchor]
        self._budget.count(size, location)
        return node

    def _check_tag(self, tag: str | None, location: SourceLocation) -> None:
        if tag is not None and tag not in _TEXT_TAGS and tag not in _IGNORED_TAGS:
            self._problems.add(location, f"the tag {quoted(tag)} is not supported in a world file")

    def _location(self, mark: ParserMark | None) -> SourceLocation:
        return (
            SourceLocation(self._file)
            if mark is None
            else SourceLocation(self._file, mark.line + 1, mark.column + 1)
        )
