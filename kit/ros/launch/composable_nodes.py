"""Composable nodes: components of a package, each started as a program of its own with its name, parameters and remappings.

ROS 2 loads components into one process, and nearly all of them are C++. The kit starts those written in Python, each in a
process of its own: topics and services connect them as in one process. A component that is not in Python is
skipped, and the launch goes on.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from kit.ros.launch.conditions import Condition
from kit.ros.launch.context import LaunchContext
from kit.ros.launch.entity import Action, LaunchDescriptionEntity
from kit.ros.launch.processes import Node
from kit.ros.launch.substitutions import SomeText
from kit.ros.launch.unavailable import SoftwareUnavailable

_EMPTY_REASON = (
    "a container for composable nodes, which is a process that loads them: the kit starts each composable node in a "
    "process of its own, and this container names none"
)


class ComposableNode(Node):
    """One component of a package: a class derived from ``Node``.

    ``plugin`` names it: by an entry point of the package's group ``rclpy_components``, or by its place, as
    ``my_package.talker:Talker`` (``::`` likewise).
    """

    def __init__(
        self,
        *,
        package: SomeText,
        plugin: SomeText,
        name: SomeText | None = None,
        namespace: SomeText | None = None,
        parameters: Iterable[Any] | None = None,
        remappings: Iterable[tuple[SomeText, SomeText]] | None = None,
        extra_arguments: Iterable[Any] | None = None,
        condition: Condition | None = None,
    ) -> None:
        """``extra_arguments``, as whether to share memory, have no effect here."""
        super().__init__(
            package=package,
            executable=plugin,
            name=name,
            namespace=namespace,
            exec_name=name,
            parameters=parameters,
            remappings=remappings,
            condition=condition,
        )

    def specification(self, context: LaunchContext) -> dict[str, Any]:
        return super().specification(context) | {"kind": "component"}


class LoadComposableNodes(Action):
    """Starts composable nodes."""

    def __init__(
        self,
        *,
        target_container: Any,
        composable_node_descriptions: Iterable[ComposableNode] | None = None,
        condition: Condition | None = None,
        **_: Any,
    ) -> None:
        super().__init__(condition=condition)
        self.descriptions = list(composable_node_descriptions or ())

    def sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        return self.descriptions

    def execute(self, context: LaunchContext) -> Iterable[LaunchDescriptionEntity]:
        return self.descriptions


class ComposableNodeContainer(LoadComposableNodes):
    """Starts composable nodes as well; the container itself is no node here."""

    def __init__(
        self,
        *,
        name: Any,
        namespace: Any,
        composable_node_descriptions: Iterable[ComposableNode] | None = None,
        condition: Condition | None = None,
        **_: Any,
    ) -> None:
        super().__init__(
            target_container=name,
            composable_node_descriptions=composable_node_descriptions,
            condition=condition,
        )

    def execute(self, context: LaunchContext) -> Iterable[LaunchDescriptionEntity]:
        if not self.descriptions:
            raise SoftwareUnavailable(_EMPTY_REASON)
        return super().execute(context)
