"""Composable nodes: components, mostly in C++, that are loaded into one process; the kit says so and goes on without."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from kit.ros.launch.conditions import Condition
from kit.ros.launch.context import LaunchContext
from kit.ros.launch.entity import Action
from kit.ros.launch.unavailable import SoftwareUnavailable

_REASON = (
    "composable nodes are libraries, nearly all in C++, that one process loads; the kit runs Python programs, each in a "
    "process of its own. A Python node is started with Node(package=..., executable=...)"
)


class ComposableNode:
    """The description of one component."""

    def __init__(self, *, package: Any, plugin: Any, name: Any = None, **_: Any) -> None:
        self.package, self.plugin, self.name = package, plugin, name


class ComposableNodeContainer(Action):
    """A process that loads components: skipped, with the reason."""

    def __init__(
        self,
        *,
        name: Any,
        namespace: Any,
        composable_node_descriptions: Iterable[ComposableNode] | None = None,
        condition: Condition | None = None,
        **_: Any,
    ) -> None:
        super().__init__(condition=condition)
        self.descriptions = list(composable_node_descriptions or ())

    def execute(self, context: LaunchContext) -> None:
        names = ", ".join(str(each.plugin) for each in self.descriptions if isinstance(each.plugin, str))
        raise SoftwareUnavailable(f"{_REASON}{f' (wanted: {names})' if names else ''}")


class LoadComposableNodes(ComposableNodeContainer):
    """Loads components into a container: skipped likewise."""

    def __init__(
        self,
        *,
        target_container: Any,
        composable_node_descriptions: Iterable[ComposableNode] | None = None,
        condition: Condition | None = None,
        **_: Any,
    ) -> None:
        super().__init__(
            name=None,
            namespace=None,
            composable_node_descriptions=composable_node_descriptions,
            condition=condition,
        )
