"""Calls the program's own services while it drives, and records its answers."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final

from kit.host.wire import printable
from kit.msg.conversion import from_dict, to_dict
from kit.msg.interfaces import find_service
from kit.world.yaml_section import Section

if TYPE_CHECKING:
    from kit.ros.execution.task import Future
    from kit.ros.graph.graph import Graph
    from kit.ros.node.client import Client

NO_ANSWER: Final = "no answer"
NO_SERVICE: Final = "no such service"

MAX_ANSWER: Final = 2000
"""Characters that are kept."""


@dataclass(frozen=True, slots=True)
class ServiceCall:
    """One call of a service at a set time of the episode."""

    name: str
    at_s: float
    """Simulated."""
    service: str
    """Full name, such as ``/driver/set_parameters``; without a slash in front that of the program's first node by name."""
    type: str
    request: Mapping[str, Any] = field(default_factory=lambda: MappingProxyType({}))
    within_s: float = math.inf
    """A later answer counts as none: a program whose callbacks wait for something else cannot be spoken to meanwhile."""


def read_service_call(section: Section) -> ServiceCall:
    """Reads one call; notes mistakes and finishes the section."""
    # Imported only where there are calls: every assignment imports this module.

    given = section.section("request", None)
    request: Mapping[str, Any] = {} if given is None else given.remaining_values()
    call = ServiceCall(
        section.name("name"),
        section.number("at", minimum=0),
        section.name("service"),
        section.name("type"),
        MappingProxyType(dict(request)),
        section.number("within", above=0) if section.has("within") else math.inf,
    )
    try:
        from_dict(find_service(call.type).Request, call.request)
    except (LookupError, ValueError, TypeError, AttributeError) as error:
        section.error(f"no such call: {error}", "type")
    section.finish()
    return call


class ServiceCaller:
    """Makes the calls when they are due, without waiting for the answers."""

    def __init__(self, graph: Graph, calls: tuple[ServiceCall, ...]) -> None:
        from kit.ros.node.node import create_graph_node

        self._calls = sorted(calls, key=lambda call: call.at_s)
        self._node = create_graph_node(graph, "grader_calls") if calls else None
        if self._node is not None:
            graph.reserved_names.add(self._node.handle.full_name)
        self._graph = graph
        self._others = frozenset(graph.directory.nodes)
        self._clients: dict[str, Client[Any, Any]] = {}
        self._futures: dict[str, Future[Any] | None] = {}
        self._deadlines: dict[str, float] = {}
        self._late: set[str] = set()

    def call_due(self, time_s: float) -> None:
        """Makes the calls due by ``time_s``; to be called once per tick."""
        if not self._calls and not self._deadlines:
            return
        for name, deadline in [*self._deadlines.items()]:
            future = self._futures[name]
            if time_s > deadline or future is None or future.done():
                del self._deadlines[name]
                if future is not None and not future.done():
                    self._late.add(name)
        while self._calls and self._calls[0].at_s <= time_s:
            self._make(self._calls.pop(0))

    def _make(self, call: ServiceCall) -> None:
        assert self._node is not None
        service_type, service = find_service(call.type), self._full_name(call.service)
        if service not in self._clients:
            self._clients[service] = self._node.create_client(service_type, service)
        client = self._clients[service]
        request = from_dict(service_type.Request, call.request)
        self._futures[call.name] = client.call_async(request) if client.service_is_ready() else None
        self._deadlines[call.name] = call.at_s + call.within_s

    def _full_name(self, service: str) -> str:
        if service.startswith("/"):
            return service
        with self._graph.lock:
            nodes = sorted(each.full_name for each in self._graph.directory.nodes if each not in self._others)
        return f"{nodes[0] if nodes else ''}/{service}"

    def answers(self) -> Mapping[str, str]:
        """Returns the answers by call, each as JSON in one line; or ``NO_SERVICE``, or ``NO_ANSWER`` for none in time."""
        return {
            name: NO_ANSWER if name in self._late else _answer_text(future)
            for name, future in self._futures.items()
        }


def _answer_text(future: Future[Any] | None) -> str:
    if future is None:
        return NO_SERVICE
    answer = future.result() if future.done() else None
    return NO_ANSWER if answer is None else printable(json.dumps(to_dict(answer)))[:MAX_ANSWER]
