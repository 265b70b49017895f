"""Reads a launch file in XML or YAML into the same launch description that a Python launch file returns."""

from __future__ import annotations

from kit.ros.launch.entity import LaunchDescription
from kit.ros.launch.frontend.action_elements import read_actions
from kit.ros.launch.frontend.element import Problems
from kit.ros.launch.frontend.xml_elements import read_xml

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
