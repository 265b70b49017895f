"""Reads a launch file in XML or YAML into the same launch description that a Python launch file returns."""

from __future__ import annotations

from xml.parsers import expat

from kit.ros.launch.entity import LaunchDescription
from kit.ros.launch.errors import LaunchError
from kit.ros.launch.frontend.action_elements import read_actions
from kit.ros.launch.frontend.element import Element, Problems, TextPosition

ROOT = "launch"


def read_launch_description(path: str, source: bytes) -> LaunchDescription:
    """The description of a launch file. Raises LaunchError, which names every mistake with its line and column."""
    problems = Problems(path)
    if path.endswith(".xml"):
        root = read_xml(source, problems)
        if root.tag != ROOT:
            root.problem(f"a launch file in XML begins with <{ROOT}>, not <{root.tag}>")
        root.text("version", None)
        deprecated = root.text("deprecated", None)
    else:
        from kit.ros.launch.frontend.yaml_elements import read_yaml  # only now: it takes PyYAML

        root, deprecated = read_yaml(source, problems), None
    actions = read_actions(root.take_actions())
    root.finish()
    problems.raise_if_any()
    return LaunchDescription(actions, deprecated_reason=deprecated)


def read_xml(source: bytes, problems: Problems) -> Element:
    """The root element. Raises LaunchError where this is no XML."""
    parser = expat.ParserCreate()
    parser.buffer_text = True
    open_elements: list[Element] = []
    roots: list[Element] = []

    def start(name: str, attributes: dict[str, str]) -> None:
        place = TextPosition(parser.CurrentLineNumber, parser.CurrentColumnNumber + 1)
        element = Element(name.replace("-", "_"), place, problems, dict(attributes))
        (open_elements[-1].children if open_elements else roots).append(element)
        open_elements.append(element)

    def text(data: str) -> None:
        if data.strip() and open_elements:
            place = TextPosition(parser.CurrentLineNumber, parser.CurrentColumnNumber + 1)
            problems.add(
                place, f"the text '{data.strip()[:30]}' does not belong in <{open_elements[-1].tag}>"
            )

    def declare_entity(*_: object) -> None:
        raise LaunchError("a launch file must not define entities")

    parser.StartElementHandler = start
    parser.EndElementHandler = lambda name: open_elements.pop()
    parser.CharacterDataHandler = text
    parser.EntityDeclHandler = declare_entity
    try:
        parser.Parse(source, True)
    except expat.ExpatError as problem:
        problems.add(
            TextPosition(problem.lineno, problem.offset + 1),
            f"this is no XML: {expat.ErrorString(problem.code)}",
        )
        problems.raise_if_any()
    return roots[0]
