"""Reads the elements of a launch file in YAML: a list of actions under ``launch``."""

from __future__ import annotations

import yaml

from kit.ros.launch.frontend.element import Element, Problems, TextPosition

ROOT = "launch"


def read_yaml(source: bytes, problems: Problems) -> Element:
    """The root element. Raises LaunchError where this is no YAML, or not of this form."""
    try:
        node = yaml.compose(source.decode("utf-8"), Loader=yaml.SafeLoader)
    except UnicodeDecodeError:
        problems.add(TextPosition(1, 1), "this is not UTF-8 text")
    except yaml.MarkedYAMLError as problem:
        mark = problem.problem_mark
        place = TextPosition(1, 1) if mark is None else TextPosition(mark.line + 1, mark.column + 1)
        problems.add(place, f"this is not YAML: {problem.problem}")
    except yaml.YAMLError as problem:
        problems.add(TextPosition(1, 1), f"this is not YAML: {problem}")
    else:
        root = Element(ROOT, TextPosition(1, 1), problems)
        if isinstance(node, yaml.MappingNode) and ROOT in (key.value for key, _ in node.value):
            for key, value in node.value:
                if key.value == ROOT:
                    root.children += _actions(value, problems)
                elif key.value != "version":
                    problems.add(_place(key), f"beside '{ROOT}:' there is no '{key.value}'")
            return root
        problems.add(TextPosition(1, 1), f"a YAML launch file starts with '{ROOT}:' and a list of actions")
    problems.raise_if_any()
    raise AssertionError("there is a problem")


def _place(node: yaml.Node) -> TextPosition:
    return TextPosition(node.start_mark.line + 1, node.start_mark.column + 1)


def _actions(node: yaml.Node, problems: Problems) -> list[Element]:
    """The actions of a list: each a mapping with one key."""
    if not isinstance(node, yaml.SequenceNode):
        problems.add(_place(node), "a list of actions is needed here")
        return []
    found = []
    for entry in node.value:
        if isinstance(entry, yaml.MappingNode) and len(entry.value) == 1:
            key, value = entry.value[0]
            found.append(_element(key.value, value, _place(key), problems))
        else:
            problems.add(_place(entry), "an action is a single key with its attributes below: '- node:'")
    return found


def _element(tag: str, node: yaml.Node, place: TextPosition, problems: Problems) -> Element:
    element = Element(tag.replace("-", "_"), place, problems)
    if isinstance(node, yaml.SequenceNode):
        element.children += _actions(node, problems)
    elif isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            _add_child(element, key.value, value, _place(key), problems)
    elif node.value not in ("", "null", "~"):
        problems.add(place, f"the attributes of '{tag}' come below it, each with its name")
    return element


def _add_child(element: Element, name: str, node: yaml.Node, place: TextPosition, problems: Problems) -> None:
    """Adds an attribute, or children of this name."""
    if name in element.attributes:
        problems.add(place, f"'{name}' appears here twice")
    elif isinstance(node, yaml.ScalarNode):
        element.attributes[name] = node.value
    elif name == "children":
        element.children += _actions(node, problems)
    elif isinstance(node, yaml.MappingNode):
        element.children.append(_element(name, node, place, problems))
    elif all(isinstance(entry, yaml.ScalarNode) for entry in node.value):
        element.attributes[name] = f"[{', '.join(_flow(entry) for entry in node.value)}]"
    else:
        element.children += [_element(name, entry, _place(entry), problems) for entry in node.value]


def _flow(node: yaml.ScalarNode) -> str:
    """A scalar as it stands in a list on one line."""
    return f"'{node.value}'" if node.style in ("'", '"') else str(node.value)
