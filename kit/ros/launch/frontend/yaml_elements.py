"""Reads the elements of a launch file in YAML: a list of actions under ``launch``."""

from __future__ import annotations

import yaml

from kit.ros.launch.bounds import MAX_ACTIONS, MAX_DEPTH, NESTED_TOO_DEEPLY
from kit.ros.launch.context import LaunchError, LaunchFileLocation
from kit.ros.launch.frontend.element import Element, Problems, TextPosition
from kit.yaml_slips import parser_mistake

ROOT = "launch"


def read_yaml(source: bytes, problems: Problems) -> Element:
    """The root element. Raises LaunchError where this is no YAML, or not of this form."""
    loader = None
    try:
        loader = yaml.SafeLoader(source.decode("utf-8"))
        node = loader.get_single_node()
    except UnicodeDecodeError:
        problems.add(TextPosition(1, 1), "this is not UTF-8 text")
    except yaml.MarkedYAMLError as problem:
        slip = parser_mistake(problem, source.decode("utf-8"))
        problems.add(TextPosition(slip.line, slip.column), f"this is not YAML: {slip.message}")
    except yaml.YAMLError as problem:
        problems.add(TextPosition(1, 1), f"this is not YAML: {problem}")
    except RecursionError:
        problems.add(TextPosition(1 if loader is None else loader.line + 1, 1), NESTED_TOO_DEEPLY)
    else:
        root = Element(ROOT, TextPosition(1, 1), problems)
        if isinstance(node, yaml.MappingNode) and ROOT in (key.value for key, _ in node.value):
            reader = _ElementReader(problems)
            for key, value in node.value:
                if key.value == ROOT:
                    root.children += reader.actions(value)
                elif key.value != "version":
                    problems.add(_place(key), f"beside '{ROOT}:' there is no '{_shown(key)}'")
            return root
        problems.add(TextPosition(1, 1), f"a YAML launch file starts with '{ROOT}:' and a list of actions")
    problems.raise_if_any()
    raise AssertionError("there is a problem")


def _place(node: yaml.Node) -> TextPosition:
    return TextPosition(node.start_mark.line + 1, node.start_mark.column + 1)


def _kind(node: yaml.Node) -> str:
    return "list" if isinstance(node, yaml.SequenceNode) else "mapping"


def _shown(key: yaml.Node) -> str:
    return key.value if isinstance(key, yaml.ScalarNode) else f"this {_kind(key)}"


class _ElementReader:
    """Makes elements of nodes. What an alias repeats counts each time, so that a small file cannot hold very many."""

    def __init__(self, problems: Problems) -> None:
        self._problems = problems
        self._depth, self._count = 0, 0

    def actions(self, node: yaml.Node) -> list[Element]:
        """The actions of a list: each a mapping with one key."""
        if not isinstance(node, yaml.SequenceNode):
            self._problems.add(_place(node), "a list of actions is needed here")
            return []
        found = []
        for entry in node.value:
            if isinstance(entry, yaml.MappingNode) and len(entry.value) == 1:
                key, value = entry.value[0]
                found += self._elements(key, [value], _place(key))
            else:
                self._problems.add(
                    _place(entry), "an action is a single key with its attributes below: '- node:'"
                )
        return found

    def _elements(
        self, key: yaml.Node, nodes: list[yaml.Node], place: TextPosition | None = None
    ) -> list[Element]:
        """An element of each node, with the key as tag, where its own place or ``place`` is; none if the key is no text."""
        if not isinstance(key, yaml.ScalarNode):
            self._problems.add(_place(key), f"a name is needed here, not a {_kind(key)}")
            return []
        return [self._element(key.value, node, place or _place(node)) for node in nodes]

    def _element(self, tag: str, node: yaml.Node, place: TextPosition) -> Element:
        self._count += 1
        self._depth += 1
        location = LaunchFileLocation(self._problems.file, place.line)
        if self._depth > MAX_DEPTH:
            raise LaunchError(NESTED_TOO_DEEPLY, location)
        if self._count > MAX_ACTIONS:
            raise LaunchError(
                f"more than {MAX_ACTIONS:,} actions and settings, with what aliases repeat", location
            )
        element = Element(tag.replace("-", "_"), place, self._problems)
        if isinstance(node, yaml.SequenceNode):
            element.children += self.actions(node)
        elif isinstance(node, yaml.MappingNode):
            for key, value in node.value:
                self._add_child(element, key, value)
        elif node.value not in ("", "null", "~"):
            self._problems.add(place, f"the attributes of '{tag}' come below it, each with its name")
        self._depth -= 1
        return element

    def _add_child(self, element: Element, key: yaml.Node, node: yaml.Node) -> None:
        """Adds an attribute, or children of this name."""
        name = key.value
        if isinstance(key, yaml.ScalarNode) and name in element.attributes:
            self._problems.add(_place(key), f"'{name}' appears here twice")
        elif isinstance(key, yaml.ScalarNode) and isinstance(node, yaml.ScalarNode):
            element.attributes[name] = node.value
        elif name == "children":
            element.children += self.actions(node)
        elif not isinstance(node, yaml.SequenceNode):
            element.children += self._elements(key, [node], _place(key))
        elif isinstance(key, yaml.ScalarNode) and all(
            isinstance(entry, yaml.ScalarNode) for entry in node.value
        ):
            element.attributes[name] = f"[{', '.join(_flow(entry) for entry in node.value)}]"
        else:
            element.children += self._elements(key, node.value)


def _flow(node: yaml.ScalarNode) -> str:
    """A scalar as it stands in a list on one line."""
    return f"'{node.value}'" if node.style in ("'", '"') else str(node.value)
