"""Small edits to a user's own YAML text: comments, order, quoting and blank lines stay as they are.

An edit is a piece of the text and what takes its place, found from the marks of PyYAML's nodes. What cannot be
edited without a guess is refused (``UnsafeEdit``), and every edited text is read again and compared with what was
wanted, node by node, before anybody sees it.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import yaml

from kit.layers.flatland.yaml_scalars import COMPUTED, format_flow_list, format_scalar

MappingStart: TypeAlias = tuple[int, int]
"""Line and column of a mapping's beginning, from 1: how ``kit.world`` names it."""


class UnsafeEdit(Exception):
    """The text cannot be edited without a guess; the message says why."""


@dataclass(frozen=True, slots=True)
class SetNameList:
    """``key`` of the mapping that begins at ``at`` shall be this list of names."""

    at: MappingStart
    key: str
    names: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class RemoveListItem:
    """The mapping that begins at ``at``, an item of a list, shall go."""

    at: MappingStart


@dataclass(frozen=True, slots=True)
class AddListItem:
    """The list at ``key`` of the file's own mapping shall have one more item, ``name: [names]``."""

    key: str
    names: tuple[str, ...]


YamlChange: TypeAlias = SetNameList | RemoveListItem | AddListItem


@dataclass(frozen=True, slots=True, order=True)
class _TextEdit:
    start: int
    end: int
    text: str


PlainValue: TypeAlias = "str | tuple[PlainValue, ...] | frozenset[tuple[str, PlainValue]]"
"""A node as a value that can be compared: a scalar's text, a list, a mapping without order."""


def apply_changes(text: str, changes: Sequence[YamlChange]) -> str:
    """The text with the changes made. Raises UnsafeEdit, and then nothing has been done."""
    try:
        document = _YamlDocument(text)
        edits = sorted(edit for change in changes for edit in document.edits_of(change))
        for before, after in itertools.pairwise(edits):
            if before.end > after.start:
                raise UnsafeEdit("two changes meet in one place")
        for edit in reversed(edits):
            text = text[: edit.start] + edit.text + text[edit.end :]
        if _YamlDocument(text).plain_value() != document.plain_value(changes):
            raise UnsafeEdit("the edited text would not say exactly what it should")
    except (yaml.YAMLError, RecursionError) as error:
        raise UnsafeEdit("it is not YAML that can be edited") from error
    return text


class _YamlDocument:
    """One YAML text as nodes with marks."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._newline = "\r\n" if "\r\n" in text else "\n"
        root = yaml.compose(text, Loader=yaml.SafeLoader)
        if not isinstance(root, yaml.MappingNode):
            raise UnsafeEdit("it does not hold a mapping")
        self._root = root
        self._uses: dict[int, int] = {}
        self._mappings: dict[MappingStart, list[yaml.MappingNode]] = {}
        self._lists: dict[int, yaml.SequenceNode] = {}
        self._index_node(root)

    def _index_node(self, node: yaml.Node) -> None:
        self._uses[id(node)] = self._uses.get(id(node), 0) + 1
        if self._uses[id(node)] > 1:
            return
        if isinstance(node, yaml.MappingNode):
            at = (node.start_mark.line + 1, node.start_mark.column + 1)
            self._mappings.setdefault(at, []).append(node)
            for key, value in node.value:
                self._index_node(key)
                self._index_node(value)
        elif isinstance(node, yaml.SequenceNode):
            for item in node.value:
                self._lists[id(item)] = node
                self._index_node(item)

    # What the text shall say

    def plain_value(self, changes: Sequence[YamlChange] = ()) -> PlainValue:
        """Returns the document as a plain value, as it is or after the changes."""
        sets = {(id(self._mapping(c.at)), c.key): c.names for c in changes if isinstance(c, SetNameList)}
        drops = {id(self._mapping(c.at)) for c in changes if isinstance(c, RemoveListItem)}
        adds = {id(self._top_list(c.key)): c.names for c in changes if isinstance(c, AddListItem)}

        def value_of(node: yaml.Node) -> PlainValue:
            if isinstance(node, yaml.MappingNode):
                pairs = {str(key.value): value_of(value) for key, value in node.value}
                wanted = {key: names for (mapping, key), names in sets.items() if mapping == id(node)}
                return frozenset({**pairs, **wanted}.items())
            if isinstance(node, yaml.SequenceNode):
                items = [value_of(item) for item in node.value if id(item) not in drops]
                if id(node) in adds:
                    items.append(frozenset({("name", adds[id(node)])}))
                return tuple(items)
            return str(node.value)

        return value_of(self._root)

    # How the text comes to say it

    def edits_of(self, change: YamlChange) -> Iterator[_TextEdit]:
        if isinstance(change, SetNameList):
            mapping = self._mapping(change.at)
            pairs = {str(key.value): (key, value) for key, value in mapping.value}
            if change.key in pairs:
                yield from self._replace(*pairs[change.key], change.names)
            else:
                yield self._insert_key(mapping, change.key, change.names)
        elif isinstance(change, RemoveListItem):
            yield self._delete_item(self._mapping(change.at))
        else:
            yield self._add(self._top_list(change.key), change.names)

    def _mapping(self, at: MappingStart) -> yaml.MappingNode:
        found = self._mappings.get(at, [])
        if len(found) != 1:
            raise UnsafeEdit(f"what begins in line {at[0]} is not written there as a mapping of its own")
        return found[0]

    def _top_list(self, key: str) -> yaml.SequenceNode:
        for name, value in self._root.value:
            if name.value == key and isinstance(value, yaml.SequenceNode):
                return value
        raise UnsafeEdit(f"it has no list of {key}")

    def _replace(self, key: yaml.Node, value: yaml.Node, names: Sequence[str]) -> Iterator[_TextEdit]:
        """The edits that make the value of a key a list of names."""
        start, end = value.start_mark.index, value.end_mark.index
        shared = any(self._uses[id(node)] > 1 for node in (value, *_scalar_nodes(value)))
        if shared or self._text[start] in "&*!":
            raise UnsafeEdit(f"the list in line {value.start_mark.line + 1} has an anchor, an alias or a tag")
        if any(COMPUTED.match(leaf.value) for leaf in _scalar_nodes(value)):
            raise UnsafeEdit(
                f"the list in line {value.start_mark.line + 1} is computed ($include, env or $eval)"
            )
        if isinstance(value, yaml.SequenceNode) and not value.flow_style:
            yield from self._replace_block(key, value, names)
        elif isinstance(value, yaml.MappingNode) or getattr(value, "style", None) in ("|", ">"):
            raise UnsafeEdit(f"the list in line {value.start_mark.line + 1} is not written as one")
        elif "#" in self._text[start:end]:
            raise UnsafeEdit(f"the list in line {value.start_mark.line + 1} has comments inside")
        else:
            yield _TextEdit(start, end, format_flow_list(names))

    def _replace_block(
        self, key: yaml.Node, value: yaml.SequenceNode, names: Sequence[str]
    ) -> Iterator[_TextEdit]:
        """A list with one name to a line: lines of names that stay are kept, with their comments."""
        kept = [item.value for item in value.value if item.value in names]
        wanted = [*kept, *(name for name in names if name not in kept)]
        if wanted != list(names):
            raise UnsafeEdit(f"the list in line {value.start_mark.line + 1} would change its order")
        for item in value.value:
            line = self._line_of(item)
            before, after = (
                self._text[line.start : item.start_mark.index],
                self._text[item.end_mark.index : line.end],
            )
            if not re.fullmatch(r"[ ]*-[ ]+", before) or not re.fullmatch(r"[ \t\r]*(#[^\n]*)?", after):
                raise UnsafeEdit(
                    f"line {item.start_mark.line + 1} holds more than {item.value}: write each name of the list in a line of its own"
                )
            if item.value not in names:
                comment = after.strip()
                indent = before[: before.index("-")]
                yield _TextEdit(
                    line.start,
                    min(line.end + 1, len(self._text)),
                    f"{indent}{comment}{self._newline}" if comment else "",
                )
        last = self._line_of(value.value[-1])
        indent = self._text[last.start : value.value[-1].start_mark.index]
        fresh = [name for name in names if name not in kept]
        if fresh:
            yield self._new_lines(last, [indent + format_scalar(name) for name in fresh])
        if not names:
            colon = re.compile(r"[ \t]*:").match(self._text, key.end_mark.index)
            if colon is None:
                raise UnsafeEdit(f"line {key.start_mark.line + 1} is not written as key: value")
            yield _TextEdit(colon.end(), colon.end(), " []")

    def _insert_key(self, mapping: yaml.MappingNode, key: str, names: Sequence[str]) -> _TextEdit:
        """One more ``key: [names]`` at the end of a mapping."""
        last = mapping.value[-1][1]
        if mapping.flow_style:
            return _TextEdit(last.end_mark.index, last.end_mark.index, f", {key}: {format_flow_list(names)}")
        for _, value in reversed(mapping.value):
            line = self._line_of(value)
            one_line = not isinstance(value, yaml.CollectionNode) or value.flow_style
            if one_line and re.fullmatch(r"[ \t\r]*(#[^\n]*)?", self._text[value.end_mark.index : line.end]):
                return self._new_lines(
                    line, [f"{' ' * mapping.start_mark.column}{key}: {format_flow_list(names)}"]
                )
        raise UnsafeEdit(
            f"the mapping in line {mapping.start_mark.line + 1} leaves no line to write {key} after"
        )

    def _delete_item(self, item: yaml.MappingNode) -> _TextEdit:
        """An item goes, with its own lines; comments after it stay."""
        within = self._lists.get(id(item))
        if within is None or self._uses[id(item)] > 1:
            raise UnsafeEdit(f"what begins in line {item.start_mark.line + 1} is not an item of one list")
        if len(within.value) == 1:
            raise UnsafeEdit(f"the list in line {within.start_mark.line + 1} would become empty")
        if within.flow_style:
            return self._drop_from_flow(within, item)
        first, last = self._line_at(item.start_mark.index), self._line_at(_content_end(item))
        if not re.fullmatch(r"[ ]*-[ ]+", self._text[first.start : item.start_mark.index]):
            raise UnsafeEdit(f"line {item.start_mark.line + 1} holds more than the item")
        return _TextEdit(first.start, min(last.end + 1, len(self._text)), "")

    def _drop_from_flow(self, within: yaml.SequenceNode, item: yaml.MappingNode) -> _TextEdit:
        location = within.value.index(item)
        if location + 1 < len(within.value):
            start, end = item.start_mark.index, within.value[location + 1].start_mark.index
        else:
            start, end = within.value[location - 1].end_mark.index, item.end_mark.index
        if "#" in self._text[start:end]:
            raise UnsafeEdit(f"the item in line {item.start_mark.line + 1} has comments inside")
        return _TextEdit(start, end, "")

    def _add(self, within: yaml.SequenceNode, names: Sequence[str]) -> _TextEdit:
        """One more item at the end of a list."""
        if not within.value:
            return _TextEdit(
                within.start_mark.index, within.end_mark.index, f"[{{name: {format_flow_list(names)}}}]"
            )
        last = within.value[-1]
        if within.flow_style:
            return _TextEdit(
                last.end_mark.index, last.end_mark.index, f", {{name: {format_flow_list(names)}}}"
            )
        line = self._line_at(last.start_mark.index)
        indent = re.match(r"[ ]*-[ ]+", self._text[line.start : last.start_mark.index])
        if indent is None:
            raise UnsafeEdit(f"line {last.start_mark.line + 1} holds more than an item of a list")
        return self._new_lines(
            self._line_at(_content_end(last)), [f"{indent[0]}name: {format_flow_list(names)}"]
        )

    def _new_lines(self, after: _LineSpan, lines: Sequence[str]) -> _TextEdit:
        """Whole lines after a line, which may be the last and without an end."""
        text = self._newline.join(lines)
        if after.end >= len(self._text):
            return _TextEdit(after.end, after.end, self._newline + text)
        return _TextEdit(after.end + 1, after.end + 1, text + self._newline)

    def _line_of(self, node: yaml.Node) -> _LineSpan:
        """The line on which a node ends."""
        return self._line_at(node.end_mark.index)

    def _line_at(self, index: int) -> _LineSpan:
        """The line of a character; ``end`` is where its newline stands."""
        end = self._text.find("\n", index)
        return _LineSpan(self._text.rfind("\n", 0, index) + 1, len(self._text) if end < 0 else end)


@dataclass(frozen=True, slots=True)
class _LineSpan:
    start: int
    end: int


def _content_end(node: yaml.Node) -> int:
    """Returns the end of a node's last scalar or flow collection: a block's own end mark lies after what follows it."""
    if isinstance(node, yaml.CollectionNode) and not node.flow_style and node.value:
        last = node.value[-1]
        return _content_end(last[1] if isinstance(node, yaml.MappingNode) else last)
    return int(node.end_mark.index)


def _scalar_nodes(node: yaml.Node) -> Iterator[yaml.ScalarNode]:
    if isinstance(node, yaml.ScalarNode):
        yield node
    elif isinstance(node, yaml.SequenceNode):
        for item in node.value:
            yield from _scalar_nodes(item)
